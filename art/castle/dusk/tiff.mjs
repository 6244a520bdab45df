// SPDX-License-Identifier: Apache-2.0
// Writes a TIFF (6.0) whose samples are bands, 8 bits each, in deflated strips.
import { deflateSync } from 'node:zlib';

// `samples` holds rows from above, of `bands` bytes a pixel. `description` is its JSON.
export function band_tiff({ width, height, bands, samples, description }) {
  const rows = 32, strips = [];
  for (let y = 0; y < height; y += rows)
    strips.push(deflateSync(samples.subarray(y * width * bands,
        Math.min(y + rows, height) * width * bands), { level: 9, memLevel: 9 }));
  const text = Buffer.from(`${JSON.stringify(description)}\0`);
  const lists = [], numbers = (size, list) => {
    const out = Buffer.alloc(size * list.length);
    list.forEach((value, i) => (size === 2 ? out.writeUInt16LE(value, 2 * i)
      : out.writeUInt32LE(value, 4 * i)));
    return out;
  };
  const begin = 8 + strips.reduce((sum, strip) => sum + strip.length, 0);
  let at = 8;
  const offsets = strips.map((strip) => (at += strip.length) - strip.length);
  const SHORT = 3, LONG = 4, ASCII = 2;
  const short = (...list) => [SHORT, list.length, numbers(2, list)];
  const long = (...list) => [LONG, list.length, numbers(4, list)];
  const entries = [[256, long(width)], [257, long(height)], [258, short(...Array(bands).fill(8))],
    [259, short(8)], [262, short(1)], [270, [ASCII, text.length, text]], [273, long(...offsets)],
    [277, short(bands)], [278, long(rows)], [279, long(...strips.map(({ length }) => length))],
    [284, short(1)], [338, short(...Array(bands - 1).fill(0))],
    [339, short(...Array(bands).fill(1))]];
  const table = Buffer.alloc(2 + 12 * entries.length + 4);
  let beyond = begin + (begin & 1) + table.length;
  table.writeUInt16LE(entries.length, 0);
  entries.forEach(([tag, [type, count, bytes]], i) => {
    const here = 2 + 12 * i;
    table.writeUInt16LE(tag, here), table.writeUInt16LE(type, here + 2);
    table.writeUInt32LE(count, here + 4);
    if (bytes.length <= 4) return void bytes.copy(table, here + 8);
    table.writeUInt32LE(beyond, here + 8);
    const padded = Buffer.concat([bytes, Buffer.alloc(bytes.length & 1)]);
    lists.push(padded), beyond += padded.length;
  });
  const head = Buffer.from('II*\0\0\0\0\0', 'latin1');
  head.writeUInt32LE(begin + (begin & 1), 4);
  return Buffer.concat([head, ...strips, Buffer.alloc(begin & 1), table, ...lists]);
}
