// SPDX-License-Identifier: Apache-2.0
// Pictures that repeat: the grain of hewn stone with pits and lichen, its relief, and soil.
import { png } from '../castle/falcon/files.mjs';
import { clamp, mix, random, smoothstep } from '../castle/falcon/field.mjs';

const SIDE = 512;

// Smooth noise between -1 and 1 that repeats after `cells` cells of the picture's side.
function repeating(cells, seed) {
  const draw = random(seed), table = Float64Array.from({ length: cells * cells }, draw);
  return (x, y) => {
    const u = x / SIDE * cells, v = y / SIDE * cells, i = Math.floor(u), k = Math.floor(v);
    const at = (a, b) => table[(a % cells) * cells + b % cells];
    const s = (u - i) ** 2 * (3 - 2 * (u - i)), t = (v - k) ** 2 * (3 - 2 * (v - k));
    return 2 * mix(mix(at(i, k), at(i + 1, k), s), mix(at(i, k + 1), at(i + 1, k + 1), s), t) - 1;
  };
}

function field(value) {
  const all = new Float64Array(SIDE * SIDE);
  for (let y = 0; y < SIDE; y++) for (let x = 0; x < SIDE; x++) all[y * SIDE + x] = value(x, y);
  return all;
}

// Discs with ragged borders: how much of each place they cover.
function spots(count, least, most, seed) {
  const all = new Float64Array(SIDE * SIDE), draw = random(seed), ragged = repeating(64, seed + 1);
  for (let n = 0; n < count; n++) {
    const cx = SIDE * draw(), cy = SIDE * draw(), r = least + (most - least) * draw() ** 3;
    const reach = Math.ceil(1.5 * r), strong = 0.4 + 0.6 * draw();
    for (let y = -reach; y <= reach; y++) for (let x = -reach; x <= reach; x++) {
      const px = (Math.floor(cx) + x + SIDE) % SIDE, py = (Math.floor(cy) + y + SIDE) % SIDE;
      const d = Math.hypot(x, y) / r + 0.35 * ragged(px, py);
      const i = py * SIDE + px;
      all[i] = Math.max(all[i], strong * smoothstep(1, 0.75, d));
    }
  }
  return all;
}

const coarse = repeating(8, 1), middle = repeating(32, 2), fine = repeating(128, 3);
const grain = repeating(256, 4), tooled = repeating(16, 5);
const pits = spots(420, 1, 5, 6), white = spots(60, 3, 16, 7), ochre = spots(46, 2, 13, 8);

const height = field((x, y) => 0.5 * coarse(x, y) + 0.35 * middle(x, y) + 0.12 * fine(x, y) +
  0.06 * grain(x, y) - 0.7 * pits[y * SIDE + x] +
  0.14 * Math.sin((x + 2 * y) * 2 * Math.PI * 12 / SIDE + 2.5 * tooled(x, y)));

function colors(color) {
  const pixels = Buffer.alloc(3 * SIDE * SIDE);
  for (let y = 0; y < SIDE; y++) for (let x = 0; x < SIDE; x++)
    color(x, y, y * SIDE + x).forEach((c, k) => {
      pixels[3 * (y * SIDE + x) + k] = Math.round(255 * clamp(c));
    });
  return png(SIDE, SIDE, pixels);
}

export const stone_picture = () => colors((x, y, i) => {
  let c = [0.86, 0.85, 0.84].map((one) => one * (1 + 0.06 * coarse(x, y) + 0.08 * middle(x, y) +
    0.07 * fine(x, y) + 0.09 * grain(x, y)) * (1 - 0.55 * pits[i]));
  c = c.map((one, k) => mix(one, [0.97, 0.98, 0.93][k] * (1 + 0.06 * grain(x, y)), 0.6 * white[i]));
  return c.map((one, k) => mix(one, [1, 0.78, 0.42][k] * (1 + 0.1 * grain(x, y)), 0.65 * ochre[i]));
});

export const stone_relief = () => colors((x, y) => {
  const at = (a, b) => height[((b + SIDE) % SIDE) * SIDE + (a + SIDE) % SIDE];
  const strong = 1.5;
  const n = [strong * (at(x - 1, y) - at(x + 1, y)), strong * (at(x, y + 1) - at(x, y - 1)), 1];
  const size = Math.hypot(...n);
  return n.map((c) => 0.5 + 0.5 * c / size);
});

export const soil_picture = () => colors((x, y, i) => {
  const c = 0.8 * (1 + 0.14 * middle(x, y) + 0.16 * fine(x, y) + 0.22 * grain(x, y)) *
    (1 - 0.5 * pits[i]);
  const straw = smoothstep(0.45, 0.7, grain(y, x) * fine(x, y) + middle(x, y));
  return [c, c * 0.99, c * 0.94].map((one, k) => mix(one, [1, 0.92, 0.7][k], 0.5 * straw));
});
