#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Writes two galaxies at nine times (galaxies-0.ply to -8), and the tower on which they are shown
// (scene.glb).
//   node art/galaxies/make_galaxies.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';

import { glb } from '../castle/falcon/files.mjs';
import { clamp, mix } from '../castle/falcon/field.mjs';
import { encounter } from './encounter.mjs';
import { make_terrace } from './terrace.mjs';

const [folder] = argv.slice(2);
if (!folder) {
  console.error('usage: node art/galaxies/make_galaxies.mjs FOLDER');
  exit(2);
}

const TIMES = [-0.3, -0.15, -0.05, 0, 0.07, 0.14, 0.22, 0.35, 0.5];  // thousand million years
const STARS = 4200, BULGE = 900;  // of each galaxy
const UNIT = 0.0002;  // metres of the files' whole numbers
const KILOPARSEC = 1 / 21;  // metres of the model
const TILT = 0.6;  // radians that the far side of the orbits' plane is raised
const REACH = 3.4;  // metres: stars that are thrown farther are left out

// The colours of stars, sRGB: a bulge is old and pale, and discs tell whose stars are whose.
const OLD = [255, 226, 178], DISCS = [[[172, 205, 255], [92, 150, 255]],
  [[255, 190, 120], [255, 112, 98]]];
const color_of = (star, which) => {
  if (star.bulge) return OLD;
  const [inner, outer] = DISCS[which], t = clamp((star.r - 1.5) / 12.5);
  return inner.map((c, k) => Math.round(mix(c, outer[k], t) * mix(0.62, 1, star.tone)));
};

// Returns a PLY file of points: whole numbers of UNIT metres, y up, and colours.
function ply(rows) {
  const head = ['ply', 'format binary_little_endian 1.0', 'comment art/galaxies/make_galaxies.mjs',
    `element vertex ${rows.length}`, ...['x', 'y', 'z'].map((one) => `property short ${one}`),
    ...['red', 'green', 'blue'].map((one) => `property uchar ${one}`), 'end_header', ''].join('\n');
  const body = Buffer.alloc(9 * rows.length);
  rows.forEach(({ at, color }, i) => {
    at.forEach((c, k) => body.writeInt16LE(c, 9 * i + 2 * k));
    body.set(color, 9 * i + 6);
  });
  return Buffer.concat([Buffer.from(head), body]);
}

let number = 0;
encounter(TIMES, STARS, BULGE, (time, galaxies) => {
  const rows = [];
  galaxies.forEach((stars, which) => {
    for (const star of stars) {
      const [x, y, z] = star.at.map((c) => c * KILOPARSEC);
      const [c, s] = [Math.cos(TILT), Math.sin(TILT)], place = [x, c * y - s * z, s * y + c * z];
      if (Math.hypot(...place) < REACH)
        rows.push({ at: place.map((c) => Math.round(c / UNIT)), color: color_of(star, which) });
    }
  });
  writeFileSync(join(folder, `galaxies-${number}.ply`), ply(rows));
  number++;
});
writeFileSync(join(folder, 'scene.glb'), glb({ generator: 'art/galaxies/make_galaxies.mjs',
  ...make_terrace() }));
