#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Paints where grass grows in the castle's courtyard: to either side of the way from the arch to
// the gate, up to where feet go around the well, thin in the shade of walls, and in tufts between
// the stones of the edges.
//   node art/castle/lawn/make_lawn.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';
import { blend, clamp, noise, smoothstep } from '../falcon/field.mjs';
import { png } from '../falcon/files.mjs';

// Metres of the scene; the picture's columns go to +x, its rows to +z.
const low = [-19, -7], high = [-8.9, 7], texel = 0.03;
const well = [-13.2, -0.55], trodden = 1.75, way = 0.8;

// Metres from a place to where feet go; below 0 there.
function from_feet(x, z) {
  const around = Math.hypot(x - well[0], z - well[1]) - trodden;
  // The way leaves the arch in the middle and ends before the gate.
  const bend = 0.25 * Math.sin(0.55 * (x + 9));
  const path = Math.abs(z - bend) - way - 0.9 * smoothstep(-10.6, -9.1, x);
  return blend(around, path, 0.7);
}

function grass(x, z) {
  const ragged = 0.22 * noise(0.9 * x, 3.1, 0.9 * z) + 0.12 * noise(2.3 * x, 8.2, 2.3 * z) +
      0.07 * noise(6.1 * x, 4.7, 6.1 * z);
  const inside = from_feet(x, z) + ragged;
  const wall = Math.min(x - low[0], z - low[1], high[1] - z, high[0] - x);
  const full = smoothstep(-0.05, 0.5, inside) * (0.35 + 0.65 * smoothstep(0, 0.6, wall));
  // Worn spots, and tufts between the stones beyond the edge.
  const worn = 1 - 0.5 * smoothstep(0.1, 0.7, noise(0.8 * x, 5.5, 0.8 * z));
  const tuft = smoothstep(0.35, 0.8, noise(8.3 * x, 1.4, 8.3 * z)) * smoothstep(-0.45, 0, inside);
  return clamp(Math.max(full * worn, 0.6 * tuft));
}

if (argv.length !== 3) {
  console.error('node art/castle/lawn/make_lawn.mjs FOLDER');
  exit(2);
}
const [width, height] = [0, 1].map((k) => Math.round((high[k] - low[k]) / texel));
const pixels = Buffer.alloc(width * height);
for (let row = 0; row < height; row++)
  for (let column = 0; column < width; column++)
    pixels[row * width + column] = Math.round(255 *
        grass(low[0] + (column + 0.5) * texel, low[1] + (row + 0.5) * texel));
writeFileSync(join(argv[2], 'courtyard_grass.png'), png(width, height, pixels, 1));
