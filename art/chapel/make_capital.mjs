#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Writes capital.spz: a carved capital as Gaussian splats, as if photographs had been taken of it
// where it stands in the chapel's evening sun. Metres, y up, zero is the middle of its underside.
//   node art/chapel/make_capital.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';
import { gzipSync } from 'node:zlib';

import { add, clamp, cross, dot, mix, noise, smoothstep, subtract, unit }
  from '../castle/falcon/field.mjs';
import { weathered } from './shapes.mjs';

const [folder] = argv.slice(2);
if (!folder) {
  console.error('usage: node art/chapel/make_capital.mjs FOLDER');
  exit(2);
}

const HIGH = 0.42, SPACING = 0.0043, WIDE = 0.245;
// The sun of content/chapel/exhibit.json: 25 degrees high, 128 degrees from -z clockwise.
const [ELEVATION, AZIMUTH] = [25, 128].map((degrees) => degrees * Math.PI / 180);
const SUN = [Math.sin(AZIMUTH) * Math.cos(ELEVATION), Math.sin(ELEVATION),
  -Math.cos(AZIMUTH) * Math.cos(ELEVATION)];
const SUNLIGHT = [0.62, 0.53, 0.4], SKYLIGHT = [0.25, 0.27, 0.3];

const bell = (d, wide) => Math.exp(-((d / wide) ** 2));

// A leaf's height over the bell: its blade with ribs, and the tip that curls over.
function leaf(turn, y, foot, tip, wide) {
  const t = (y - foot) / (tip - foot);
  if (t < -0.05 || t > 1.25) return 0;
  const half = wide * (0.62 + 0.5 * t - 0.75 * t ** 3) * (1 + 0.13 * Math.cos(26 * t));
  const blade = smoothstep(half, 0.72 * half, Math.abs(turn)) * smoothstep(1.12, 0.98, t);
  const rib = bell(turn, 0.03) - 0.5 * bell(Math.abs(turn) - 0.35 * half - 0.05 * t, 0.025);
  const curl = bell(y - tip, 0.024) * bell(turn, 0.62 * wide);
  return blade * (0.014 + 0.016 * t + 0.005 * rib) + 0.05 * curl * (1 - 0.25 * bell(turn, 0.025));
}

// The distance of the surface from the axis.
function radius(angle, y) {
  const around = (k, shift) => {
    const turn = angle + shift - Math.round((angle + shift) * k / (2 * Math.PI)) * 2 * Math.PI / k;
    return turn;
  };
  const rough = 0.0022 * noise(9 * angle, 60 * y, 1) + 0.0012 * noise(30 * angle, 160 * y, 2);
  if (y > HIGH - 0.085) {  // the abacus: a square with hollow sides and cut corners
    const turn = around(4, 0), side = WIDE / Math.cos(turn) - 0.022 * Math.cos(2 * turn) ** 2;
    const step = y > HIGH - 0.04 ? 0 : 0.016 + 0.5 * Math.max(0, HIGH - 0.06 - y);
    return Math.min(side, 1.28 * WIDE) - step + rough;
  }
  const ring = 0.155 + 0.012 * Math.sqrt(clamp(1 - ((y - 0.02) / 0.02) ** 2));
  if (y < 0.042) return ring + rough;
  const plain = 0.142 + 0.075 * smoothstep(0.1, HIGH - 0.08, y) ** 1.5;
  const low = leaf(around(8, 0), y, 0.04, 0.185, 0.36);
  const high = leaf(around(8, Math.PI / 8), y, 0.05, 0.29, 0.34);
  return plain + Math.max(low, 0.92 * high) + rough;
}

const place = (angle, y) => {
  const r = radius(angle, y);
  return [r * Math.cos(angle), y, r * Math.sin(angle)];
};
const is_inside = ([x, y, z]) => y > 0 && y < HIGH &&
  Math.hypot(x, z) < radius(Math.atan2(z, x), y) - 0.001;
function is_free(from, way, reach, step) {
  for (let d = step; d < reach; d += step) if (is_inside(add(from, way, d))) return false;
  return true;
}

// Ways to the sky around +y, evenly spread.
const WAYS = Array.from({ length: 14 }, (_, i) => {
  const up = 1 - (i + 0.5) / 14 * 1.15, side = Math.sqrt(1 - up * up);
  return [side * Math.cos(2.4 * i), up, side * Math.sin(2.4 * i)];
});

const splats = [];
function add_splat(p, normal) {
  const far = p.map((c) => 6 * c);
  let color = weathered([far[0] + 3, 1.4, far[2] + far[1]], [normal[0], 0.62 * normal[1],
    normal[2]], 0.17, { ground: -3 });
  color = color.map((c) => c * (1 + 0.12 * noise(...p.map((one) => one * 180))));
  const off = add(p, normal, 0.004);
  const sun = Math.max(0, dot(normal, SUN)) * (is_free(off, SUN, 0.3, 0.008) ? 1 : 0);
  let sky = 0;
  for (const way of WAYS)
    sky += Math.max(0, dot(normal, way)) * (is_free(off, way, 0.12, 0.012) ? 1 : 0.12);
  sky = sky / WAYS.length * 2 + 0.12;
  const light = color.map((c, i) => c * (SUNLIGHT[i] * sun + SKYLIGHT[i] * sky));
  splats.push({ p, normal, color: light.map((c) => mix(12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055,
      c > 0.0031308 ? 1 : 0)) });
}

const columns = Math.round(2 * Math.PI * 0.215 / SPACING);
for (let i = 0; i < columns; i++) {
  const angle = 2 * Math.PI * (i + 0.5) / columns, path = [];
  for (let y = 0.001; y < HIGH; y += 0.0012) path.push(y);
  let rest = SPACING * noise(i * 7.7, 3, 3) ** 2;
  for (let k = 0; k + 1 < path.length; k++) {
    const a = place(angle, path[k]), b = place(angle, path[k + 1]);
    const long = Math.hypot(...subtract(b, a));
    for (; rest < long; rest += SPACING) {
      const p = add(a, subtract(b, a), rest / long), y = p[1];
      const up = subtract(place(angle, Math.min(y + 0.002, HIGH - 1e-4)), place(angle, y - 0.002));
      const along = subtract(place(angle + 0.008, y), place(angle - 0.008, y));
      const steep = long > 0.004 ? subtract(b, a) : up;
      const normal = unit(cross(steep, along));
      add_splat(p, dot(normal, [p[0], 0, p[2]]) < 0 && Math.abs(normal[1]) < 0.9
          ? normal.map((c) => -c) : normal);
    }
    rest -= long;
  }
}
for (let x = -0.32; x < 0.32; x += 1.15 * SPACING) for (let z = -0.32; z < 0.32; z += 1.15 * SPACING) {
  if (Math.hypot(x, z) < radius(Math.atan2(z, x), HIGH - 0.001) - 0.002)
    add_splat([x, HIGH + 0.0015 * noise(30 * x, 30 * z, 4), z], [0.02 * noise(40 * x, 40 * z, 5), 1,
      0.02 * noise(40 * x, 40 * z, 6)]);
}

// SPZ, version 2 (github.com/nianticlabs/spz, "File Format"): columns of bytes, packed by gzip.
const count = splats.length, FRACTION = 16, head = Buffer.alloc(16);
head.writeUInt32LE(0x5053474e, 0);
head.writeUInt32LE(2, 4);
head.writeUInt32LE(count, 8);
head.writeUInt8(FRACTION, 13);
const byte = (x) => clamp(Math.round(x), 0, 255);
const places = Buffer.alloc(9 * count), opacities = Buffer.alloc(count, 250);
const [colors, scales, turns] = [0, 1, 2].map(() => Buffer.alloc(3 * count));
const scale_code = (metres) => byte(16 * (Math.log(metres) + 10));
splats.forEach(({ p, normal, color }, i) => {
  p.forEach((c, k) => places.writeIntLE(Math.round(c * 2 ** FRACTION), 9 * i + 3 * k, 3));
  color.forEach((c, k) => {
    colors[3 * i + k] = byte(255 * ((c - 0.5) / 0.2820948 * 0.15 + 0.5));
  });
  scales.set([0.72 * SPACING, 0.72 * SPACING, 0.12 * SPACING].map(scale_code), 3 * i);
  // The turn from +z to the normal; w is positive and follows from the rest.
  const [x, y, z] = normal, w = Math.sqrt(Math.max(0, (1 + z) / 2));
  const turn = w > 1e-3 ? [-y / (2 * w), x / (2 * w), 0] : [1, 0, 0];
  turns.set(turn.map((c) => byte(127.5 * (c + 1))), 3 * i);
});
writeFileSync(join(folder, 'capital.spz'), gzipSync(Buffer.concat([head, places, opacities, colors,
  scales, turns]), { level: 9 }));
