#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Paints the second falcon: a TIFF of 31 bands.
//   node art/castle/dusk/make_dusk.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';
import { random } from '../falcon/field.mjs';
import { mix_pigments } from '../spectra/pigments.mjs';
import { BANDS, index_of, mixtures } from './palette.mjs';
import { ROW, see } from './scene.mjs';
import { band_tiff } from './tiff.mjs';

const WIDTH = 1152, HEIGHT = 768, GAMMA = 2.2;
const [folder] = argv.slice(2);
if (!folder) {
  console.error('usage: node art/castle/dusk/make_dusk.mjs FOLDER');
  exit(2);
}

const seen = Array.from({ length: WIDTH * HEIGHT }, (_, i) =>
  see((i % WIDTH + 0.5) / HEIGHT, (Math.floor(i / WIDTH) + 0.5) / HEIGHT));
// Both hands' skies are painted as one.
const kind = ({ row }) => (row === ROW.retouch ? ROW.sky : row);
const canvas = seen.map(({ row, tone }) => index_of(row, tone));
const chance = random(11);

// A stroke keeps the mixture that it began with; each bristle leaves a little more or less white.
// It ends where something else begins, up to `over` pixels beyond.
function stroke(length, width, loose, over) {
  const x0 = Math.floor(chance() * WIDTH), y0 = Math.floor(chance() * HEIGHT);
  const { row, tone, direction } = seen[y0 * WIDTH + x0];
  const size = Math.hypot(...direction), turn = (chance() - 0.5) * 0.35;
  const [c, s] = [Math.cos(turn), Math.sin(turn)];
  const [dx, dy] = [(direction[0] * c - direction[1] * s) / size,
    (direction[0] * s + direction[1] * c) / size];
  const bend = (chance() - 0.5) * 0.6 / length, lighter = (chance() - 0.5) * loose;
  const bristles = Array.from({ length: Math.ceil(2 * width) + 1 }, () => (chance() - 0.5) * loose);
  const begins = bristles.map(() => chance() * 0.2 * length);
  bristles.forEach((shade, b) => {
    const side = (b / (bristles.length - 1) - 0.5) * width;
    let beyond = 0;
    for (let t = begins[b]; t < length * (0.85 + 0.15 * chance()); t += 0.5) {
      const along = t - length / 2, arc = bend * along * along;
      const x = Math.round(x0 + dx * along - dy * (side + arc));
      const y = Math.round(y0 + dy * along + dx * (side + arc));
      if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT) continue;
      const there = seen[y * WIDTH + x];
      if (kind(there) !== kind(seen[y0 * WIDTH + x0])) {
        if (++beyond > 2 * over) return;
      } else {
        beyond = 0;
      }
      const own = kind(there) === ROW.sky && kind({ row }) === ROW.sky ? there.row
        : row === ROW.retouch ? ROW.sky : row;
      canvas[y * WIDTH + x] = index_of(own, tone + lighter + shade);
    }
  });
}
for (const [count, length, width, loose, over] of [[2500, 90, 21, 0.12, 4], [9000, 50, 10, 0.12, 2],
  [26000, 26, 5, 0.12, 1.5], [90000, 13, 2.2, 0.1, 0.7]])
  for (let i = 0; i < count; i++) stroke(length, width, loose, over);
// Small things are painted last, with a fine brush.
seen.forEach(({ row, tone }, i) => {
  if (row === ROW.falcon) canvas[i] = index_of(row, tone + (chance() - 0.5) * 0.08);
});

const code = (value) => Math.round(255 * Math.min(Math.max(value, 0), 1) ** (1 / GAMMA));
const coats = mixtures.map((parts) => mix_pigments(parts, BANDS).map(code));
const samples = Buffer.alloc(WIDTH * HEIGHT * BANDS.length);
canvas.forEach((index, i) => samples.set(coats[index], i * BANDS.length));
writeFileSync(join(folder, 'second_falcon.tif'), band_tiff({ width: WIDTH, height: HEIGHT,
  bands: BANDS.length, samples, description: { wavelengths_nm: BANDS, white: 255, gamma: GAMMA,
    source: 'Computed of models of pigments, art/castle/dusk; the Wellspring authors, '
        + 'Apache License 2.0' } }));
