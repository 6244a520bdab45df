// SPDX-License-Identifier: Apache-2.0
// The mummy's outer face as one function: the mesh and the scan are both made of it.
// Millimetres; x to the bird's left, y up from the base, z to the front.
import { blend, chain, clamp, curve, ellipsoid, mix, noise, smoothstep } from './field.mjs';

export const BEAK = [[0, 357, 34, 15], [0, 356, 47, 11.5], [0, 350, 57, 8], [0, 341, 63.5, 5],
  [0, 331, 66, 2.6], [0, 326, 65.4, 1.5]];
export const EYE = [29.5, 359, 29];

// Heights, with half the width, half the depth and how far the middle lies to the front.
const PROFILE = curve([[-4, 43, 39, 0], [8, 44.5, 40, 0], [15, 43, 38.5, 0], [22, 38, 34, 0],
  [34, 38.5, 34.5, 0], [60, 42, 37.5, 0], [110, 49, 43, 0], [160, 54.5, 47.5, 0],
  [205, 59, 50, 1], [240, 62, 51.5, 1], [266, 59, 49, 1], [288, 50, 44, 0], [304, 41, 38.5, 0],
  [318, 36, 35, 0], [345, 30, 30, 0]], 4);

const TABLE = new Float64Array(3 * 360);
for (let y = 0, i = 0; y < 360; y++) {
  while (i + 2 < PROFILE.length && PROFILE[i + 1][0] < y) i++;
  const t = clamp((y - PROFILE[i][0]) / (PROFILE[i + 1][0] - PROFILE[i][0]));
  for (let k = 0; k < 3; k++) TABLE[3 * y + k] = mix(PROFILE[i][k + 1], PROFILE[i + 1][k + 1], t);
}
const profile = (y, k) => {
  const at = clamp(y, 0, 358.999), row = Math.floor(at);
  return mix(TABLE[3 * row + k], TABLE[3 * row + 3 + k], at - row);
};

// The form without bands and edges.
function form(x, y, z) {
  const a = profile(y, 0), b = profile(y, 1), middle = profile(y, 2);
  const px = x / a, pz = (z - middle) / b;
  const inside = Math.sqrt(px * px + pz * pz);
  let d = inside * (inside - 1) / Math.hypot(px / a, pz / b, 1e-6);
  d = y < 310 ? d : mix(d, 40, smoothstep(312, 350, y));
  d += 0.9 * noise(x / 38, y / 46, z / 38);
  if (y > 255) {
    const side = Math.abs(x);
    let head = ellipsoid([0, 360, 2], [40.5, 57, 42], x, y, z);
    head = blend(head, ellipsoid([0, 350, 18], [30, 34, 30], x, y, z), 12);
    if (z > 0) {
      head = blend(head, chain([[12, 378, 37, 5], [26, 373, 33, 5], [37, 364, 20, 3.5]],
          side, y, z), 7);
      head = blend(head, ellipsoid(EYE, [9, 8.5, 8.5], side, y, z), 2);
      head = blend(head, chain(BEAK, x, y, z), 5);
    }
    d = blend(d, head, 16);
  }
  return d;
}

// The lower edge of the painted cartonnage: a bib in front, a short cape behind.
export const bib = (angle) =>
  252 + 20 * smoothstep(0.5, 2.4, Math.abs(angle)) - 16 * Math.exp(-((angle / 0.75) ** 2));

// How far a point lies from the rim of its lozenge towards its middle: 1 at the rim, 0 there.
// `which` tells neighbouring strips apart.
export function lozenge(x, y, z, angle) {
  const turn = 5 * (angle + 0.03 * noise(x / 30, y / 40, z / 30)) / (2 * Math.PI);
  const climb = (y + 1.6 * noise(z / 25, x / 25, y / 35)) / 74;
  const p = turn + climb, q = turn - climb + 0.5;
  const u = 2 * Math.abs(p - Math.floor(p) - 0.5), v = 2 * Math.abs(q - Math.floor(q) - 0.5);
  return { rim: Math.max(u, v), over: u > v, which: Math.floor(p) + 2 * Math.floor(q) };
}
export const STEPS = [0.24, 0.44, 0.63, 0.82];

// How high bands, studs and the cartonnage's edge stand out.
function relief(x, y, z) {
  const angle = Math.atan2(x, z);
  const edge = bib(angle);
  let high = 0;
  if (y > 30 && y < edge + 4) {
    const { rim } = lozenge(x, y, z, angle);
    let steps = 0;
    for (const step of STEPS) steps += smoothstep(step - 0.035, step + 0.035, rim);
    steps = 0.5 * steps + 1.3 * (1 - smoothstep(0.08, 0.17, rim));
    high += steps * smoothstep(37, 40, y) * (1 - smoothstep(edge - 3, edge, y));
  }
  for (const [low, top, amount] of [[20, 30, 1.1], [29, 38, 1.9], [2, 12, 0.8]])
    high += amount * smoothstep(low, low + 2, y + 0.8 * Math.sin(2 * angle))
      * (1 - smoothstep(top - 2, top, y + 0.8 * Math.sin(2 * angle)));
  high += 2.6 * smoothstep(edge - 1, edge + 1, y);
  if (y > 290 && y < 350 && z > 30) {  // the gape
    const line = y - 345 + 0.012 * x * x;
    high -= 1.1 * Math.exp(-((line / 1.4) ** 2)) * smoothstep(30, 38, z)
        * (1 - smoothstep(56, 60, z));
  }
  return high;
}

// Is 0 on the outer face and negative inside; in its neighbourhood about a distance.
export function outside(x, y, z) {
  let d = form(x, y, z);
  const far = Math.abs(d);
  if (far < 14) d -= relief(x, y, z) * (1 - smoothstep(7, 14, far));
  return -y > d - 3 ? -blend(-d, y, 2.4) : d;
}

// The way in which the field grows, not of unit length.
export function gradient(x, y, z, step = 0.35) {
  return [outside(x + step, y, z) - outside(x - step, y, z),
    outside(x, y + step, z) - outside(x, y - step, z),
    outside(x, y, z + step) - outside(x, y, z - step)].map((c) => c / (2 * step));
}

// Moves a point along the gradient to where the field is `level`.
export function settle(point, level = 0, rounds = 6) {
  let p = point;
  for (let i = 0; i < rounds; i++) {
    const g = gradient(...p), size = g[0] ** 2 + g[1] ** 2 + g[2] ** 2;
    const move = clamp((outside(...p) - level) / Math.max(size, 0.05), -3, 3);
    p = p.map((c, k) => c - move * g[k]);
  }
  return p;
}
