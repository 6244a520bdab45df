// SPDX-License-Identifier: Apache-2.0
// This worker decodes keyframes: {id, color, depth, width, height, layer, sway} becomes {id,
// bitmap, units, blocks, codes} or {id, problem}. `blocks` has the farthest and the nearest units
// of each block of pixels and those around them, row after row; of a layer only where there is
// anything, and the farthest is nearer than the nearest where there is not.
import { decode_disparity, inflate } from './disparity.js';
import { decode_jpeg } from './jpeg.js';
import { block } from './view.js';

function bound_blocks(units, width, height, layer) {
  const columns = Math.ceil(width / block), rows = Math.ceil(height / block);
  const out = new Uint16Array(2 * columns * rows);
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      const x0 = Math.max(column * block - 1, 0), x1 = Math.min((column + 1) * block + 1, width);
      const y1 = Math.min((row + 1) * block + 1, height);
      let low = 65535, high = 0;
      for (let y = Math.max(row * block - 1, 0); y < y1; y++)
        for (let i = y * width + x0; i < y * width + x1; i++) {
          if (layer && units[i] === 0) continue;
          if (units[i] < low) low = units[i];
          if (units[i] > high) high = units[i];
        }
      out[2 * (row * columns + column)] = low;
      out[2 * (row * columns + column) + 1] = high;
    }
  return out;
}

self.onmessage = async ({ data: { id, color, depth, width, height, layer, sway } }) => {
  try {
    const [bitmap, units, codes] = await Promise.all([
      decode_jpeg(color),
      decode_disparity(depth, width, height),
      sway ? inflate(sway.codes, sway.columns * sway.rows) : null,
    ]);
    const blocks = bound_blocks(units, width, height, layer);
    /** @type {any} */ (self).postMessage({ id, bitmap, units, blocks, codes },
        [bitmap, units.buffer, blocks.buffer]);
  } catch (problem) {
    self.postMessage({ id, problem: String(problem) });
  }
};
