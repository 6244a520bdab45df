// SPDX-License-Identifier: Apache-2.0
// Shows the newest picture: while one is being decoded only the latest that arrived meanwhile is
// kept.
import { read_picture } from './packet.js';

/** @param {Blob} blob @returns {Promise<ImageBitmap | HTMLImageElement>} */
async function decode_jpeg(blob) {
  if ('createImageBitmap' in window) return createImageBitmap(blob);
  const image = new Image();
  image.src = URL.createObjectURL(blob);
  try {
    await image.decode();
    return image;
  } finally {
    URL.revokeObjectURL(image.src);
  }
}

// on_shown({frame, seq, decoded_ms, ...}) after a picture is on the canvas.
export function make_picture(canvas, on_shown) {
  const context = canvas.getContext('2d', { alpha: false, desynchronized: true });
  let decoding = false, waiting = null, shown = 0;
  const times = [];

  async function decode(picture) {
    decoding = true;
    const began = performance.now();
    try {
      const bitmap = await decode_jpeg(new Blob([picture.payload], { type: 'image/jpeg' }));
      const decoded_ms = performance.now() - began;
      if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
        canvas.width = bitmap.width;
        canvas.height = bitmap.height;
      }
      context.drawImage(bitmap, 0, 0);
      if ('close' in bitmap) bitmap.close();
      shown++;
      times.push(performance.now());
      while (times.length && times[times.length - 1] - times[0] > 1000) times.shift();
      on_shown({ ...picture, payload: null, bytes: picture.payload.byteLength, decoded_ms });
    } catch {
      // A broken picture is left out; the next one is on its way.
    }
    decoding = false;
    if (waiting) { const next = waiting; waiting = null; decode(next); }
  }

  return {
    receive(buffer) {
      const picture = read_picture(buffer);
      if (!picture) return;
      if (decoding) waiting = picture; else decode(picture);
    },
    count: () => shown,
    rate: () => Math.max(0, times.length - 1),
  };
}

// The size to ask the server for: the window's shape, at most `most` pixels, never more than the
// screen has.
export function wanted_size(most = 1280 * 720) {
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const width = Math.max(64, innerWidth * ratio), height = Math.max(64, innerHeight * ratio);
  const scale = Math.min(1, Math.sqrt(most / (width * height)));
  return { width: Math.round(width * scale / 8) * 8, height: Math.round(height * scale / 8) * 8 };
}
