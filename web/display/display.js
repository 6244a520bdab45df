// SPDX-License-Identifier: Apache-2.0
// The picture as this page draws it: keyframes with depth from the server, seen by a camera that
// moves here.
import { read_picture } from '../packet.js';
import { decode_jpeg } from './jpeg.js';
import { view_of } from './view.js';
import { make_ground, make_walker } from './walker.js';
import { make_warp } from './warp.js';

// `canvas`: that of finished pictures, over which one of its own is laid. on_shown: as of
// make_picture(). round_trip(): milliseconds. null: there is no WebGL2.
export function make_display(canvas, { on_shown, round_trip }) {
  let fresh = false;  // there is something new to be drawn
  const own = document.createElement('canvas');
  own.className = 'local';
  own.hidden = true;
  const warp = make_warp(own, (lost) => {
    own.hidden = true;
    fresh = !lost;
  });
  if (!warp) return null;
  canvas.after(own);
  const walker = make_walker();
  const worker = new Worker(new URL('./decoder.js', import.meta.url), { type: 'module' });
  const decoding = new Map();  // frame -> what takes the worker's answer
  let size = [canvas.width, canvas.height], deep = false;
  let last = performance.now(), drawn = 0, work = Promise.resolve();
  const times = [];  // of the last second's pictures

  worker.onmessage = ({ data }) => {
    decoding.get(data.id)(data);
    decoding.delete(data.id);
  };
  const decode_keyframe = ({ frame, keyframe: { color_bytes, view }, payload }) =>
    new Promise((resolve) => {
      decoding.set(frame, resolve);
      const color = payload.slice(0, color_bytes), depth = payload.slice(color_bytes);
      worker.postMessage({ id: frame, color, depth, width: view.width, height: view.height },
          [color.buffer, depth.buffer]);
    });

  async function show_keyframe(picture) {
    const { view, unit, cuts } = picture.keyframe;
    const { bitmap, units, blocks, problem } = await decode_keyframe(picture);
    if (problem) throw new Error(problem);
    warp.add({ view, unit, cuts, bitmap, units, blocks }, performance.now(), picture.around);
  }
  async function change(picture) {
    const pieces = await Promise.all(picture.parts.map(async (part) =>
      ({ bitmap: await decode_jpeg(part.payload), x: part.x, y: part.y })));
    await warp.change(pieces, picture.width, picture.height);
    for (const { bitmap } of pieces) bitmap.close();
  }
  async function take(picture) {
    const began = performance.now();
    let good = true;
    try {
      await (picture.parts ? change(picture) : show_keyframe(picture));
      fresh = true;
    } catch (problem) {
      console.warn(`picture ${picture.frame}: ${problem}`);
      good = false;
    }
    on_shown({ ...picture, payload: null, parts: null, keyframe: null, shown: good,
      bytes: picture.payload.byteLength, decoded_ms: performance.now() - began });
  }

  function frame(now) {
    requestAnimationFrame(frame);
    const dt = Math.min(0.1, Math.max(0, now - last) / 1000);
    last = now;
    const moved = walker.advance(dt, now), pose = walker.pose();
    if (!pose || !deep || !(moved || fresh || warp.fades(now))) return;
    fresh = false;
    if (!warp.show(view_of(pose, ...size), now)) return;
    own.hidden = false;
    drawn++;
    canvas.dataset.drawn = String(drawn);
    times.push(now);
    while (times.length && now - times[0] > 1000) times.shift();
  }
  requestAnimationFrame(frame);

  return {
    walker,
    // Returns whether the picture is one for this display.
    receive(buffer) {
      const picture = read_picture(buffer);
      if (!picture) return true;
      if (!picture.parts) deep = picture.keyframe !== null;
      if (deep) work = work.then(() => take(picture));
      else own.hidden = true;
      return deep;
    },
    welcome(message) {
      size = [message.width, message.height];
      [canvas.width, canvas.height] = size;
      if (message.map)
        fetch(`api/v1/exhibits/${message.exhibit}/map`).then((answer) => answer.json())
            .then((map) => walker.set_ground(make_ground(map)), () => {});
    },
    told(message) {
      const { width, height } = message;
      if (width !== size[0] || height !== size[1]) {
        size = [width, height];
        [canvas.width, canvas.height] = size;
      }
      walker.told(message, performance.now(), round_trip());
    },
    rate: () => Math.max(0, times.length - 1),
  };
}
