// SPDX-License-Identifier: Apache-2.0
// Shows the newest picture: while one is being decoded only the latest complete one that arrived
// meanwhile is kept, and the parts that came after it.
import { read_picture } from './packet.js';

/**
 * @param {Uint8Array<ArrayBuffer>} bytes of a JPEG
 * @returns {Promise<ImageBitmap | HTMLImageElement>}
 */
export async function decode_jpeg(bytes) {
  const blob = new Blob([bytes], { type: 'image/jpeg' });
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

function copy_of(canvas) {
  const copy = document.createElement('canvas');
  copy.width = canvas.width;
  copy.height = canvas.height;
  copy.getContext('2d').drawImage(canvas, 0, 0);
  return copy;
}

// on_shown({frame, seq, shown, decoded_ms, ...}) after a picture is on the canvas. shown: false: it
// could not be decoded.
export function make_picture(canvas, on_shown) {
  const context = canvas.getContext('2d', { alpha: false, desynchronized: true });
  let busy = false, waiting = [], shown = 0, bytes = 0;
  const times = [];

  function fit(width, height, keeps) {
    if (canvas.width === width && canvas.height === height) return;
    const before = keeps ? copy_of(canvas) : null;
    canvas.width = width;
    canvas.height = height;
    if (before) context.drawImage(before, 0, 0, width, height);
  }

  async function show(picture) {
    const pieces = picture.parts ?? [{ x: 0, y: 0, payload: picture.payload }];
    const bitmaps = await Promise.all(pieces.map((piece) => decode_jpeg(piece.payload)));
    if (picture.parts) fit(picture.width, picture.height, true);
    else fit(bitmaps[0].width, bitmaps[0].height, false);
    bitmaps.forEach((bitmap, i) => {
      context.drawImage(bitmap, pieces[i].x, pieces[i].y);
      if ('close' in bitmap) bitmap.close();
    });
  }

  async function work(picture) {
    busy = true;
    const began = performance.now();
    let good = true;
    try {
      await show(picture);
      shown++;
      times.push(performance.now());
      while (times.length && times[times.length - 1] - times[0] > 1000) times.shift();
    } catch {
      good = false;  // a broken picture is left out
    }
    bytes += picture.payload.byteLength;
    on_shown({ ...picture, parts: null, payload: null, bytes: picture.payload.byteLength,
      shown: good, decoded_ms: performance.now() - began });
    busy = false;
    const next = waiting.shift();
    if (next) work(next);
  }

  return {
    receive(buffer) {
      const picture = read_picture(buffer);
      if (!picture) return;
      if (picture.keyframe) {  // it is for a page that draws by itself
        on_shown({ ...picture, payload: null, keyframe: null, bytes: picture.payload.byteLength,
          shown: false, decoded_ms: 0 });
        return;
      }
      if (!picture.parts) waiting = [];
      if (busy) waiting.push(picture); else work(picture);
    },
    count: () => shown,
    bytes: () => bytes,
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
