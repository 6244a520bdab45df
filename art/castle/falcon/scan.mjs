// SPDX-License-Identifier: Apache-2.0
// The scan: Hounsfield units of linen, cartonnage, dried tissue, bones, feathers, resin and metal.
import { add, blend, chain, clamp, cross, curve, ellipsoid, mix, noise, smoothstep, triangle,
  unit } from './field.mjs';
import { crack, PIN, RESIN } from './repair.mjs';
import { bib, outside } from './outside.mjs';
import { make_skeleton, NECK, ring_place, RUMP, SKULL } from './skeleton.mjs';

// The space between samples; both faces of a sheet fade over two of them.
export const SPACING = 0.9;
const LOW = [-69.3, -5.4, -58.5], HIGH = [69.3, 424, 75.6];
export const AIR = -1000, SKIN = -300;
const QUANTUM = 8;
export const SIZE = LOW.map((low, k) => Math.ceil((HIGH[k] - low) / SPACING) + 1);

// The grid runs to the left, back and up.
const [NX, NZ, NY] = [SIZE[0], SIZE[2], SIZE[1]];
const index = (i, j, k) => (k * NZ + j) * NX + i;
const x_at = (i) => LOW[0] + SPACING * i;
const z_at = (j) => HIGH[2] - SPACING * j;
const y_at = (k) => LOW[1] + SPACING * k;

// Calls `visit(index, x, y, z)` for all samples of a box, given by the mummy's axes.
function each(low, high, visit) {
  const range = (a, b, count) => [Math.max(0, Math.ceil(a)), Math.min(count - 1, Math.floor(b))];
  const [i0, i1] = range((low[0] - LOW[0]) / SPACING, (high[0] - LOW[0]) / SPACING, NX);
  const [j0, j1] = range((HIGH[2] - high[2]) / SPACING, (HIGH[2] - low[2]) / SPACING, NZ);
  const [k0, k1] = range((low[1] - LOW[1]) / SPACING, (high[1] - LOW[1]) / SPACING, NY);
  for (let k = k0; k <= k1; k++)
    for (let j = j0; j <= j1; j++)
      for (let i = i0; i <= i1; i++) visit(index(i, j, k), x_at(i), y_at(k), z_at(j));
}
const bounds = (points, far) => [0, 1, 2].map((k) => points.map((p) => p[k]))
  .map((c) => [Math.min(...c) - far, Math.max(...c) + far]);
function around(points, far, visit) {
  const box = bounds(points, far);
  each(box.map(([low]) => low), box.map(([, high]) => high), visit);
}
// How much of a sample is filled by what begins at distance 0.
const cover = (d) => clamp(0.5 - d / (1.3 * SPACING));

const CHEST = [[0, 252, -1, 25], [0, 225, -3, 25], [0, 195, -8, 20], [0, 165, -17, 13],
  [0, 136, -24, 7]];
const THROAT = NECK.map((p, i) => [...p, 7 + 0.3 * i]);
// The bird's skin.
function body(x, y, z) {
  const side = Math.abs(x);
  let d = y < 290 ? chain(CHEST, x, y, z) : 60;
  if (y > 190 && y < 300)
    d = blend(d, chain([[9, 256, 20, 12], [8, 214, 15, 9]], side, y, z), 8);
  if (y > 190 && y < 310)
    d = Math.min(d, chain([[22, 288, -5, 9], [36, 207, -22, 6], [37, 284, 10, 5],
      [39, 226, 15, 4]], side, y, z));
  if (y > 40 && y < 215)
    d = blend(d, chain([[13, 189, -14, 13], [27, 166, 19, 10], [21, 120, 6, 5.5],
      [19, 98, -6, 4.5], [17, 62, 8, 4.5]], side, y, z), 5);
  if (y > 255) {
    d = blend(d, chain(THROAT, x, y, z), 8);
    d = blend(d, ellipsoid([SKULL[0], SKULL[1] - 1, SKULL[2] + 5], [22, 20, 26], x, y, z), 8);
    d = blend(d, chain([[0, 364, 20, 9], [0, 358, 34, 7]], x, y, z), 6);
  }
  return d;
}
const CAVITY = [[0, 238, -4], [15, 34, 15]];
const PACK = [[0, 190, -4], [12, 17, 10]];

// Linen at `depth` under the face: turns of a band with loose threads of air between them.
function linen(depth, x, y, z, angle) {
  const turn = angle / (2 * Math.PI);
  const slack = 0.5 * noise(x / 21, y / 28, z / 21) + 0.22 * noise(x / 8, y / 12, z / 8);
  const layer = depth / 4.1 + turn + slack;
  const within = layer - Math.floor(layer), number = Math.floor(layer);
  const loose = 0.12 * noise(x / 17, y / 23, z / 17);
  const web = smoothstep(0.02, 0.24, within) * (1 - smoothstep(0.66 + loose, 0.9 + loose, within));
  const lean = number % 2 ? turn : -turn;
  const wide = 25 + ((number * 13) % 5 + 5) % 5 * 4;
  const strip = (y + 4 * noise(x / 20, number, z / 20)) / wide + 2 * lean + 0.37 * number;
  const edge = Math.abs(strip - Math.floor(strip) - 0.5);
  const seam = smoothstep(0.445, 0.485, edge);
  const tone = [-70, 30, -20, 70, 0][(((number * 7) % 5) + 5) % 5];
  return mix(-680, -290 + tone, web * (1 - 0.8 * seam)) - 50 * smoothstep(8, 30, depth);
}

function soft(samples, depths) {
  for (let k = 0, at = 0; k < NY; k++)
    for (let j = 0; j < NZ; j++)
      for (let i = 0; i < NX; i++, at++) {
        const depth = depths[at];
        if (depth < -SPACING * 1.02) continue;
        const face = clamp(0.5 + depth / (2 * SPACING));
        if (depth < 1.3) {
          samples[at] = mix(AIR, SKIN, face);
          continue;
        }
        const x = x_at(i), y = y_at(k), z = z_at(j);
        const angle = Math.atan2(x, z);
        const skin = body(x, y, z);
        const shell = y > bib(angle) + 0.5 * noise(x, y, z);
        let value;
        if (skin < 0) value = flesh(skin, x, y, z);
        else {
          const near = smoothstep(13, 3, skin);
          const wrapped = linen(mix(depth, 30 - skin, near > 0.5 ? 1 : 0), x, y, z, angle);
          value = wrapped;
          const down = smoothstep(3.2, 0.4, skin);
          if (down > 0) value = mix(value, -780 + 160 * noise(x / 1.5, y / 9, z / 1.5), down);
          if (y > 298) {  // the head's own wrapping stands free in the cartonnage
            const room = smoothstep(7.5, 8.5, skin + 2 * noise(x / 9, y / 9, z / 9))
                * smoothstep(306, 311, y + 6 * noise(x / 12, 5, z / 12) - 0.007 * (x * x + z * z));
            const wad = smoothstep(0.28, 0.5, noise(x / 11, y / 13, z / 11));
            value = mix(value, mix(-985, -720, wad), room);
          }
        }
        if (shell) value = cartonnage(value, depth, x, y, z);
        const fade = smoothstep(1.3, 2.2, depth);
        samples[at] = mix(SKIN, value, fade);
      }
}

// Two layers of linen with plaster between them, and the crack with its resin.
function cartonnage(value, depth, x, y, z) {
  let result = value;
  const inner = smoothstep(5.4, 4.6, depth);
  result = mix(result, -240, inner);
  result = mix(result, 420 + 50 * noise(x / 3, y / 3, z / 3),
      smoothstep(1.2, 2, depth) * smoothstep(4.2, 3.5, depth));
  const { gap, patch } = crack(x, y, z);
  if (gap > 0 && depth < 5.6) result = mix(result, RESIN, gap);
  if (patch > 0) result = mix(result, RESIN - 20, patch * smoothstep(4.4, 4.9, depth)
      * smoothstep(6.9, 6.2, depth));
  return result;
}

function flesh(skin, x, y, z) {
  const fibre = noise(x / 2.2, y / 11, z / 2.2);
  let value = mix(45 + 55 * fibre, 150, smoothstep(-2.2, -0.6, skin));
  const shrunk = smoothstep(0.35, 0.6, noise(x / 6, y / 14, z / 6)) * smoothstep(-2, -4, skin);
  value = mix(value, -820, 0.9 * shrunk);
  if (y > 150 && y < 290) {
    const hollow = cover(ellipsoid(...CAVITY, x, y, z));
    if (hollow > 0) {
      const level = z + 11.5 + 0.5 * noise(x / 5, y / 5, 0);  // it set while the bird lay there
      value = mix(value, mix(-970, 95, cover(level)), hollow);
    }
    const pack = cover(ellipsoid(...PACK, x, y, z) + 1.6 * noise(x / 5, y / 5, z / 5));
    if (pack > 0) {
      const lump = noise(x / 2.4, y / 2.4, z / 2.4);
      value = mix(value, mix(-120, 310, smoothstep(-0.25, 0.35, lump)), pack);
    }
  }
  return value;
}

// Distances of solids and of the hollows in them, and what both are of.
function lay_bones(samples, bones) {
  const lay = (d, at, wall, hounsfield, core) => {
    const full = cover(d);
    if (full <= 0) return;
    samples[at] = mix(samples[at], hounsfield, full);
    const hollow = cover(d + wall);
    if (hollow > 0) samples[at] = mix(samples[at], core, hollow);
  };
  for (const bone of bones.filter(({ kind }) => kind !== 'plate')) {
    if (bone.kind === 'tube') {
      const widest = Math.max(...bone.points.map((p) => p[3])) + 2;
      around(bone.points, widest, (at, x, y, z) =>
        lay(chain(bone.points, x, y, z), at, bone.wall, bone.hounsfield, bone.core));
    } else {
      around([bone.centre], Math.max(...bone.radii) + 2, (at, x, y, z) => {
        const whole = ellipsoid(bone.centre, bone.radii, x, y, z);
        let d = whole;
        for (const { centre, radius } of bone.cuts)
          d = Math.max(d, radius - Math.hypot(x - centre[0], y - centre[1], z - centre[2]));
        let sheet = Math.max(d, -whole - bone.wall);
        for (const { centre, radius } of bone.cuts) {
          const wall = Math.abs(Math.hypot(x - centre[0], y - centre[1], z - centre[2])
              - radius - 0.5) - 0.5;
          sheet = Math.min(sheet, Math.max(wall, whole));
        }
        const within = cover(whole + bone.wall);
        if (within > 0) {
          const rest = cover(z - bone.centre[2] + 0.45 * bone.radii[2]);  // what is left of it
          const inside = cover(d) * within;
          samples[at] = mix(samples[at], mix(-960, 60, rest), inside);
        }
        samples[at] = mix(samples[at], bone.hounsfield, cover(sheet));
      });
    }
  }
  for (const { corners, thick, hounsfield } of bones.filter(({ kind }) => kind === 'plate'))
    around(corners, thick + 2, (at, x, y, z) => {
      const full = cover(triangle(corners, [x, y, z]) - thick);
      if (full > 0) samples[at] = Math.max(samples[at], mix(samples[at], hounsfield, full));
    });
}

function lay_feathers(samples, quills) {
  const lines = quills.map(({ root, belly, tip, radius }) => curve([root, belly, tip], 7)
    .map((p, i, all) => [...p, mix(radius, 0.35, i / (all.length - 1))]));
  for (const [n, line] of lines.entries()) {
    const next = lines[n + 1];
    if (next && Math.hypot(...[0, 1, 2].map((k) => line[8][k] - next[8][k])) < 14)
      for (let i = 4; i + 1 < line.length; i++)
        for (const corners of [[line[i], line[i + 1], next[i]],
          [line[i + 1], next[i], next[i + 1]]])
          around(corners, 2, (at, x, y, z) => {
            const full = cover(triangle(corners, [x, y, z]) - 0.45);
            if (full > 0) samples[at] = Math.max(samples[at], mix(samples[at], -330, full));
          });
  }
  for (const line of lines) {
    around(line, 4, (at, x, y, z) => {
      const full = cover(chain(line, x, y, z));
      if (full > 0) samples[at] = Math.max(samples[at], mix(samples[at], 260, full));
    });
    const calamus = line.slice(0, 5).map((p) => [...p.slice(0, 3), p[3] - 0.75]);
    around(calamus, 3, (at, x, y, z) => {
      samples[at] = mix(samples[at], -700, cover(chain(calamus, x, y, z)));
    });
  }
}

// A finger ring with a bezel, pushed over the left shin.
export const RING = { inner_mm: 15, hounsfield: 3900 };
function lay_metal(samples) {
  const { centre, along } = ring_place();
  const axis = unit(add(unit(along), [0.22, 0.1, 0.16]));
  const aside = unit(cross(axis, [1, 0, 0.3])), ahead = cross(axis, aside);
  const middle = add(centre, [1.5, 0, 0.5]);
  const wide = RING.inner_mm / 2 + 1.2;
  const hoop = Array.from({ length: 49 }, (_, i) => {
    const a = 2 * Math.PI * i / 48;
    const front = Math.max(0, Math.cos(a)) ** 6;
    return [...add(add(middle, ahead, wide * Math.cos(a)), aside, wide * Math.sin(a)),
      1.05 + 0.5 * front];
  });
  const bezel = add(middle, ahead, wide + 1.1);
  around(hoop, 6, (at, x, y, z) => {
    const p = [x - bezel[0], y - bezel[1], z - bezel[2]];
    const local = [p[0] * aside[0] + p[1] * aside[1] + p[2] * aside[2],
      p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2],
      p[0] * ahead[0] + p[1] * ahead[1] + p[2] * ahead[2]];
    let seal = ellipsoid([0, 0, 0], [5.2, 3.9, 1.7], ...local);
    const rim = Math.abs(Math.hypot(local[0] / 5.2, local[1] / 3.9) - 0.66) * 4;
    if (local[2] > 0.2) seal = Math.max(seal, 0.55 - rim);
    const full = cover(Math.min(chain(hoop, x, y, z), seal));
    if (full > 0) samples[at] = mix(samples[at], RING.hounsfield, full);
  });
  const pin = PIN.line();
  around(pin, 4, (at, x, y, z) => {
    const full = cover(chain(pin, x, y, z));
    if (full > 0) samples[at] = mix(samples[at], PIN.hounsfield, full);
  });
}

// Returns size (left, back, up), the samples, and where they lie for `nrrd`.
export function make_scan() {
  const samples = new Float32Array(NX * NY * NZ).fill(AIR);
  const field = new Float32Array(samples.length).fill(99);
  each(LOW, [999, 999, 999], (at, x, y, z) => { field[at] = outside(x, y, z); });
  const depths = new Float32Array(samples.length).fill(-99);
  const steps = [1, NX, NX * NZ];
  for (let at = steps[2]; at < samples.length - steps[2]; at++) {
    if (field[at] > 6) continue;
    const slope = Math.hypot(...steps.map((step) => field[at + step] - field[at - step]));
    const flat = smoothstep(1.5, 4, Math.abs(field[at]));
    depths[at] = -field[at] / mix(clamp(slope / (2 * SPACING), 0.5, 2), 1, flat);
  }
  soft(samples, depths);
  const { bones, quills } = make_skeleton();
  lay_feathers(samples, quills);
  lay_bones(samples, bones);
  lay_metal(samples);
  const whole = Int16Array.from(samples, (v) => Math.round(v / QUANTUM) * QUANTUM);
  const spaced = (k) => [0, 1, 2].map((n) => (n === k ? SPACING : 0));
  return { size: [NX, NZ, NY], samples: whole, axes: [0, 1, 2].map(spaced),
    origin: [LOW[0], -HIGH[2], LOW[1]].map((c) => +c.toFixed(3)) };
}
