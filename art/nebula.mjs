#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Draws a planetary nebula that nobody has seen: an hourglass of two lobes, a bright ring round its
// waist, a bubble within, filaments that follow no symmetry, and the stars before and behind it.
//   node art/nebula.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';
import { deflateSync } from 'node:zlib';

const side = 320, steps = 150;
const angle = 0.62, tilt = 0.48;  // of the axis in the picture, and towards the visitor

// A number from 0 to 1 for whole numbers, the same on every machine.
function hash(x, y, z) {
  let h = Math.imul(x, 0x8da6b343) ^ Math.imul(y, 0xd8163841) ^ Math.imul(z, 0xcb1ab31f);
  h = Math.imul(h ^ (h >>> 15), 0x2c1b3c6d);
  h = Math.imul(h ^ (h >>> 12), 0x297a2d39);
  return ((h ^ (h >>> 15)) >>> 0) / 2 ** 32;
}
const mix = (a, b, t) => a + (b - a) * t;
function noise(x, y, z) {
  const [i, j, k] = [x, y, z].map(Math.floor);
  const [u, v, w] = [x - i, y - j, z - k].map((t) => t * t * (3 - 2 * t));
  const edge = (dj, dk) => mix(hash(i, j + dj, k + dk), hash(i + 1, j + dj, k + dk), u);
  return mix(mix(edge(0, 0), edge(1, 0), v), mix(edge(0, 1), edge(1, 1), v), w);
}
// Thin bright lines where noise crosses its middle.
function filaments(x, y, z) {
  let sum = 0, size = 1;
  for (let octave = 0; octave < 3; octave++) {
    const ridge = 1 - Math.abs(2 * noise(x / size + 7.3, y / size + 2.1, z / size + 4.7) - 1);
    sum += size * ridge ** 5;
    size /= 2;
  }
  return sum / 1.75;
}
const bell = (x, width) => Math.exp(-((x / width) ** 2));

// Adds the light of a place to `light`; z runs along the axis, the nebula is about 1 long each way.
function glow(x, y, z, light) {
  const r = Math.hypot(x, y), far = Math.hypot(r, z), around = Math.atan2(y, x);
  if (far > 1) return;
  const end = Math.abs(z), upper = z > 0;
  const thread = filaments(6.5 * x + (upper ? 0 : 9), 6.5 * y, 4 * z);
  // The lobes: one is a little longer, and each bulges to one side.
  const length = upper ? 0.86 : 0.8;
  const bulge = 1 + 0.12 * Math.cos(around - (upper ? 0.7 : 3.4));
  const part = Math.min(end / length, 1);
  const wall = (0.09 + 0.3 * Math.sin(Math.PI * part ** 0.8) ** 0.75) * bulge * (1 - part ** 6);
  const thin = 0.022 + 0.03 * part;
  const fade = Math.max(0, 1 - part ** 3) * (1 + 0.45 * Math.cos(around + 1.9 + 2 * z));
  const lobe = bell(r - wall, thin) * fade * (0.06 + 2.6 * thread ** 1.4);
  const inside = r < wall ? (1 - part) * 0.2 * (1 - (r / wall) ** 4) : 0;
  add(light, 2.6 * lobe, 0.26 * lobe, 0.42 * lobe);
  const lining = bell(r - wall + 0.03, thin) * fade * (0.3 + thread) * (1 - 0.6 * part);
  add(light, 0.02 * lining, 0.75 * lining, 0.8 * lining);
  add(light, 0.06 * inside, 0.62 * inside, 0.9 * inside);
  // The ring round the waist.
  const warm = bell(Math.hypot(r - 0.2 - 0.012 * Math.sin(3 * around), z), 0.036) *
      (0.55 + 0.9 * noise(9 * x, 9 * y, 9 * z)) * (1 + 0.4 * Math.cos(around - 0.4));
  add(light, 8.5 * warm, 3.4 * warm, 1.2 * warm);
  // The bubble, and the glow about the star that made it all.
  const bubble = bell(Math.hypot(r, 0.72 * z) - 0.125, 0.022) * (0.5 + noise(14 * x, 14 * y, 11 * z));
  add(light, 0.4 * bubble, 2.9 * bubble, 3.1 * bubble);
  const heart = bell(far, 0.07);
  add(light, 1.2 * heart, 1.7 * heart, 2.2 * heart);
  // Knots beyond the lobes, not quite opposite one another.
  for (const [kx, ky, kz, size] of [[0.05, 0.02, 0.93, 0.035], [-0.07, 0.04, -0.9, 0.03]]) {
    const knot = bell(Math.hypot(x - kx, y - ky, 0.6 * (z - kz)), size);
    add(light, 9 * knot, 1.4 * knot, 1.1 * knot);
  }
  // The halo of older gas.
  const halo = bell(far - 0.25, 0.3) * (1 - far * far) * (0.3 + 1.3 * filaments(2.2 * x, 2.2 * y, 2.2 * z + 3));
  add(light, 0.06 * halo, 0.07 * halo, 0.21 * halo);
}
function add(light, red, green, blue) {
  light[0] += red, light[1] += green, light[2] += blue;
}

function draw_nebula(picture) {
  const [ca, sa, ct, st] = [Math.cos(angle), Math.sin(angle), Math.cos(tilt), Math.sin(tilt)];
  for (let row = 0; row < side; row++)
    for (let column = 0; column < side; column++) {
      const px = (2.16 * (column + 0.5)) / side - 1.08, py = 1.08 - (2.16 * (row + 0.5)) / side;
      const along = px * ca + py * sa, beside = py * ca - px * sa, light = [0, 0, 0];
      if (Math.hypot(px, py) < 1)
        for (let i = 0; i < steps; i++) {
          const depth = (2 * (i + 0.5)) / steps - 1;
          glow(beside, depth * ct - along * st, along * ct + depth * st, light);
        }
      light.forEach((value, c) => {
        picture[3 * (row * side + column) + c] = (value * 2) / steps;
      });
    }
}

function draw_stars(picture) {
  const tints = [[1, 0.93, 0.85], [0.8, 0.9, 1], [1, 1, 1], [1, 0.78, 0.55], [0.72, 0.84, 1]];
  for (let star = 0; star < 85; star++) {
    const random = (what) => hash(star, what, 77);
    const x = random(0) * side, y = random(1) * side;
    const light = 0.04 * (1 / (0.01 + random(2))) ** 0.8, size = 0.62 + 0.11 * Math.log1p(light);
    const tint = tints[Math.floor(random(3) * tints.length)];
    const reach = 9;
    for (let row = Math.max(0, Math.floor(y - reach)); row <= Math.min(side - 1, y + reach); row++)
      for (let column = Math.max(0, Math.floor(x - reach));
        column <= Math.min(side - 1, x + reach); column++) {
        const away = Math.hypot(column + 0.5 - x, row + 0.5 - y);
        const seen = light * (bell(away, 1.3 * size) + 0.006 * bell(away, 3.6));
        tint.forEach((part, c) => {
          picture[3 * (row * side + column) + c] += part * seen;
        });
      }
  }
}

// Light becomes an sRGB code; what is brighter than white keeps some of its hue.
function encode(picture) {
  const rows = Buffer.alloc(side * side * 3);
  for (let pixel = 0; pixel < side * side; pixel++) {
    const light = [0, 1, 2].map((c) => 1.45 * picture[3 * pixel + c]);
    const peak = Math.max(...light, 1e-9);
    const shown = peak < 0.5 ? peak : 1 - 0.25 / peak;
    light.forEach((value, c) => {
      const level = mix((value / peak) * shown, shown, Math.max(0, shown - 0.75) * 0.9);
      const code = level <= 0.0031308 ? 12.92 * level : 1.055 * level ** (1 / 2.4) - 0.055;
      rows[3 * pixel + c] = Math.round(255 * Math.min(1, Math.max(0, code)));
    });
  }
  return rows;
}

// A PNG file of 8-bit RGB (ISO/IEC 15948); each row is told by its differences from its neighbours.
function encode_png(width, height, rgb) {
  const table = Array.from({ length: 256 }, (_, n) => {
    for (let bit = 0; bit < 8; bit++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n;
  });
  const chunk = (name, data) => {
    const body = Buffer.concat([Buffer.from(name, 'latin1'), data]), ends = Buffer.alloc(8);
    let sum = ~0;
    for (const byte of body) sum = table[(sum ^ byte) & 255] ^ (sum >>> 8);
    ends.writeUInt32BE(data.length, 0), ends.writeUInt32BE(~sum >>> 0, 4);
    return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
  };
  const line = 3 * width, rows = Buffer.alloc((line + 1) * height);
  for (let y = 0; y < height; y++) {
    rows[y * (line + 1)] = 4;  // Paeth
    for (let i = 0; i < line; i++) {
      const at = y * line + i;
      const left = i < 3 ? 0 : rgb[at - 3], above = y < 1 ? 0 : rgb[at - line];
      const corner = i < 3 || y < 1 ? 0 : rgb[at - line - 3], guess = left + above - corner;
      const away = [left, above, corner].map((value) => Math.abs(guess - value));
      const best = away[0] <= away[1] && away[0] <= away[2] ? left
          : away[1] <= away[2] ? above : corner;
      rows[y * (line + 1) + 1 + i] = rgb[at] - best;
    }
  }
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0), head.writeUInt32BE(height, 4), head.set([8, 2, 0, 0, 0], 8);
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', head),
    chunk('sRGB', Buffer.from([0])), chunk('IDAT', deflateSync(rows, { level: 9 })),
    chunk('IEND', Buffer.alloc(0))]);
}

const folder = argv[2];
if (!folder) {
  console.error('usage: node art/nebula.mjs FOLDER');
  exit(2);
}
const picture = new Float64Array(side * side * 3);
draw_nebula(picture);
draw_stars(picture);
writeFileSync(join(folder, 'nebula.png'), encode_png(side, side, encode(picture)));
