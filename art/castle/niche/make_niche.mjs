#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Writes a cabinet of dark wood with a black dome in its front, in which a cloud of light floats.
// Metres, y up, its front to +z at z = 0; the dome's middle lies at (0, EYE, 0).
//   node art/castle/niche/make_niche.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';

import { glb } from '../falcon/files.mjs';

const [folder] = argv.slice(2);
if (!folder) {
  console.error('usage: node art/castle/niche/make_niche.mjs FOLDER');
  exit(2);
}

const EYE = 1.5, WIDTH = 0.96, HEIGHT = 2.12, DEPTH = 0.5, HOLE = 0.36, RING = 0.026, AROUND = 64;

const parts = new Map();
function part(name, material) {
  if (!parts.has(name))
    parts.set(name, { name, material, points: [], normals: [], triangles: [] });
  return parts.get(name);
}
// Adds corners with their normals, counter-clockwise as seen from the front.
function add(to, corners, normals) {
  const first = to.points.length;
  to.points.push(...corners);
  to.normals.push(...normals);
  for (let i = 2; i < corners.length; i++) to.triangles.push([first, first + i - 1, first + i]);
}
const flat = (to, corners, normal) => add(to, corners, corners.map(() => normal));
const circle = (i, radius, z = 0) => {
  const angle = 2 * Math.PI * i / AROUND;
  return [radius * Math.cos(angle), EYE + radius * Math.sin(angle), z];
};

// The front: from the circle to the rectangle around it.
const half = WIDTH / 2, wood = part('Niche', 'dark wood');
function rim([x, y]) {
  const to = [x, y - EYE];
  const sides = [half / Math.abs(to[0]), (to[1] > 0 ? HEIGHT - EYE : EYE) / Math.abs(to[1])];
  const scale = Math.min(...sides.filter(Number.isFinite));
  return [to[0] * scale, EYE + to[1] * scale, 0];
}
const corners = [[half, HEIGHT, 0], [-half, HEIGHT, 0], [-half, 0, 0], [half, 0, 0]];
for (let i = 0; i < AROUND; i++) {
  const a = circle(i, HOLE), b = circle(i + 1, HOLE), c = rim(b), d = rim(a);
  // A corner of the rectangle between two spokes belongs to the piece.
  const between = corners.filter((corner) => {
    const side = (p, q) => p[0] * (q[1] - EYE) - (p[1] - EYE) * q[0];
    return side(a, corner) > 1e-9 && side(corner, b) > 1e-9;
  });
  flat(wood, [a, d, ...between, c, b], [0, 0, 1]);
}
const box = [[-half, 0], [half, 0], [half, HEIGHT], [-half, HEIGHT]];
for (const [i, j, normal] of [[0, 1, [0, -1, 0]], [1, 2, [1, 0, 0]], [2, 3, [0, 1, 0]],
  [3, 0, [-1, 0, 0]]]) {
  const [[x0, y0], [x1, y1]] = [box[i], box[j]];
  flat(wood, [[x0, y0, 0], [x0, y0, -DEPTH], [x1, y1, -DEPTH], [x1, y1, 0]], normal);
}
flat(wood, [[half, 0, -DEPTH], [-half, 0, -DEPTH], [-half, HEIGHT, -DEPTH],
  [half, HEIGHT, -DEPTH]], [0, 0, -1]);

// The dome: half a sphere, seen from inside.
const dome = part('Dome', 'night'), rings = 20;
const place = (i, k) => {
  const away = Math.PI / 2 * k / rings, [x, y] = circle(i, HOLE * Math.cos(away));
  return [x, y, -HOLE * Math.sin(away)];
};
const inward = ([x, y, z]) => [-x / HOLE, (EYE - y) / HOLE, -z / HOLE];
for (let k = 0; k < rings; k++)
  for (let i = 0; i < AROUND; i++) {
    const four = [place(i, k), place(i + 1, k), place(i + 1, k + 1), place(i, k + 1)];
    const seen = k + 1 === rings ? four.slice(0, 3) : four;
    add(dome, seen, seen.map(inward));
  }

// A ring of brass around it: half a torus.
const brass = part('Niche Ring', 'brass'), turns = 8;
const torus = (i, k) => {
  const tilt = Math.PI * k / turns, [x, y] = circle(i, 1);
  const out = [x, y - EYE], r = HOLE + RING / 2 - RING / 2 * Math.cos(tilt);
  const z = RING / 2 * Math.sin(tilt);
  return { p: [out[0] * r, EYE + out[1] * r, z],
    n: [-out[0] * Math.cos(tilt), -out[1] * Math.cos(tilt), Math.sin(tilt)] };
};
for (let k = 0; k < turns; k++)
  for (let i = 0; i < AROUND; i++) {
    const four = [torus(i, k), torus(i, k + 1), torus(i + 1, k + 1), torus(i + 1, k)];
    add(brass, four.map(({ p }) => p), four.map(({ n }) => n));
  }

const pbr = (color, roughness, metallic = 0) => ({ baseColorFactor: [...color, 1],
  metallicFactor: metallic, roughnessFactor: roughness });
writeFileSync(join(folder, 'niche.glb'), glb({
  generator: 'art/castle/niche/make_niche.mjs', parts: [...parts.values()],
  materials: [
    { name: 'dark wood', pbrMetallicRoughness: pbr([0.09, 0.05, 0.028], 0.5) },
    { name: 'night', pbrMetallicRoughness: pbr([0.004, 0.004, 0.006], 0.95) },
    { name: 'brass', pbrMetallicRoughness: pbr([0.72, 0.50, 0.22], 0.3, 1) },
  ] }));
