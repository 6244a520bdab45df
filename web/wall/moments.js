// SPDX-License-Identifier: Apache-2.0
// Shows a tile's pictures in step with the others: each is decoded at once and acknowledged, and
// appears when the server says so, which is when all tiles have theirs. One that is late for its
// moment appears as soon as it is decoded.
import { decode_jpeg } from '../picture.js';
import { read_picture } from '../packet.js';

const is_later = (frame, than) => ((frame - than) | 0) > 0;

// on_decoded({frame, decoded_ms, shown: whether it could be decoded}); on_shown(frame).
export function make_moments(canvas, { on_decoded, on_shown }) {
  const context = canvas.getContext('2d', { alpha: false });
  let ready = [];  // [{frame, bitmap}], oldest first
  let released = null, seen = null;  // frames: the last that may be shown, the last that is

  function show() {
    if (released === null) return;
    const due = ready.filter(({ frame }) => !is_later(frame, released));
    ready = ready.filter(({ frame }) => is_later(frame, released));
    const last = due.pop();
    for (const { bitmap } of due) bitmap.close?.();
    if (!last || (seen !== null && !is_later(last.frame, seen))) return;
    const { frame, bitmap } = last;
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
    }
    context.drawImage(bitmap, 0, 0);
    bitmap.close?.();
    seen = frame;
    on_shown(frame);
  }

  return {
    async receive(buffer) {
      const picture = read_picture(buffer);
      if (!picture) return;
      const { frame } = picture, began = performance.now();
      let good = true;
      try {
        ready.push({ frame, bitmap: await decode_jpeg(picture.payload) });
        ready.sort((a, b) => (a.frame - b.frame) | 0);
      } catch {
        good = false;  // a broken picture is left out
      }
      on_decoded({ frame, decoded_ms: performance.now() - began, shown: good });
      show();
    },
    // The pictures of that number are to be seen.
    release(frame) {
      released = frame;
      show();
    },
    // A new connection counts anew.
    joined() {
      for (const { bitmap } of ready) bitmap.close?.();
      ready = [];
      released = seen = null;
    },
  };
}
