#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Writes the castle's wrapped falcon: its scan, its mesh, its vitrine, and a replica with faults.
//   node art/castle/falcon/make_falcon.mjs FOLDER [FILE ...]
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';

import { add, cross, subtract, unit } from './field.mjs';
import { glb, nrrd, png } from './files.mjs';
import { make_picture, place_uv } from './paint.mjs';
import { displace, make_truth } from './replica.mjs';
import { make_scan } from './scan.mjs';
import { make_surface } from './surface.mjs';
import { make_vitrine } from './vitrine.mjs';

const [folder, ...wanted] = argv.slice(2);
if (!folder) {
  console.error('usage: node art/castle/falcon/make_falcon.mjs FOLDER [FILE ...]');
  exit(2);
}
function write(name, make) {
  if (wanted.length && !wanted.includes(name)) return;
  const bytes = make();
  writeFileSync(join(folder, name), bytes);
  console.log(`${name}: ${bytes.length} bytes`);
}
const generator = 'art/castle/falcon/make_falcon.mjs';
const mean_normals = (points, triangles) => {
  const sums = points.map(() => [0, 0, 0]);
  for (const corners of triangles) {
    const [a, b, c] = corners.map((i) => points[i]), n = cross(subtract(b, a), subtract(c, a));
    for (const i of corners) sums[i] = add(sums[i], n);
  }
  return sums.map(unit);
};
const in_metres = (points) => points.map((p) => p.map((c) => c / 1000));

// Points that lie at the picture's left and right edge are there twice.
function mummy() {
  const { points, normals, triangles } = make_surface(2.4);
  const uv = points.map(place_uv), twin = new Map();
  const sewn = triangles.map((corners) => {
    const us = corners.map((i) => uv[i][0]);
    if (Math.max(...us) - Math.min(...us) < 0.5) return corners;
    return corners.map((i) => {
      if (uv[i][0] > 0.5) return i;
      if (!twin.has(i)) {
        twin.set(i, points.length);
        points.push(points[i]);
        normals.push(normals[i]);
        uv.push([uv[i][0] + 1, uv[i][1]]);
      }
      return twin.get(i);
    });
  });
  const width = 960, height = 1120;
  return glb({ generator, pictures: [png(width, height, make_picture(width, height))],
    parts: [{ name: 'Falcon', material: 'linen and paint', points: in_metres(points), normals, uv,
      triangles: sewn }],
    materials: [{ name: 'linen and paint', pbrMetallicRoughness: {
      baseColorTexture: { index: 0 }, metallicFactor: 0, roughnessFactor: 0.78 } }] });
}

const notes = ['A falcon that never was, made by art/castle/falcon; Apache License 2.0',
  'Hounsfield units; the outer face lies at -650'];
write('falcon.nrrd', () => nrrd({ ...make_scan(), notes }));
write('falcon.glb', mummy);
write('vitrine.glb', () => glb(make_vitrine()));

const face = make_surface(2.8);
const moved = face.points.map((p, i) => displace(p, face.normals[i]));
write('replica.glb', () => glb({ generator,
  parts: [{ name: 'Replica', material: 'printed', points: in_metres(moved),
    normals: mean_normals(moved, face.triangles), triangles: face.triangles }],
  materials: [{ name: 'printed', pbrMetallicRoughness: {
    baseColorFactor: [0.62, 0.61, 0.58, 1], metallicFactor: 0, roughnessFactor: 0.6 } }] }));
write('replica.json', () =>
  Buffer.from(`${JSON.stringify(make_truth(face, moved), null, 1)}\n`));
