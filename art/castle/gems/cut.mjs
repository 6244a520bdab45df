// SPDX-License-Identifier: Apache-2.0
// Cuts gems: a stone is what is left between planes, so that it is closed and each facet flat. A
// stone's table faces +y, its girdle lies about y = 0. Metres.
import { cross, dot, subtract, unit } from '../falcon/field.mjs';

const SAME = 1e-7;  // metres between corners that are one

// Returns the facets of what lies on the inner side of all planes [normal, distance]: lists of
// corners, counter-clockwise as seen from outside.
export function cut(planes) {
  const far = 1, box = [];
  for (let axis = 0; axis < 3; axis++)
    for (const side of [-1, 1]) {
      const u = (axis + 1) % 3, v = (axis + 2) % 3;
      const corner = (a, b) => {
        const p = [0, 0, 0];
        p[axis] = side * far, p[u] = a * far, p[v] = b * far;
        return p;
      };
      const loop = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
      box.push(side > 0 ? loop : loop.reverse());
    }
  return planes.reduce((facets, [normal, distance]) => {
    const away = (p) => dot(normal, p) - distance, rim = [], left = [];
    for (const facet of facets) {
      const kept = [];
      facet.forEach((p, i) => {
        const q = facet[(i + 1) % facet.length], [a, b] = [away(p), away(q)];
        if (a <= SAME / 10) kept.push(p);
        if ((a > SAME / 10 && b < -SAME / 10) || (a < -SAME / 10 && b > SAME / 10))
          kept.push(p.map((c, k) => c + (q[k] - c) * a / (a - b)));
      });
      const corners = apart(kept);
      if (corners.length < 3) continue;
      left.push(corners);
      rim.push(...corners.filter((p) => Math.abs(away(p)) < SAME));
    }
    const cap = around(apart_all(rim), normal);
    return cap.length < 3 || left.length === 0 ? left.filter((facet) => !lies_in(facet, away))
      : [...left.filter((facet) => !lies_in(facet, away)), cap];
  }, box);
}
const near = (p, q) => Math.hypot(...subtract(p, q)) < SAME;
const apart = (loop) => loop.filter((p, i) => !near(p, loop[(i + 1) % loop.length]));
const apart_all = (points) => points.filter((p, i) => !points.slice(0, i).some((q) => near(p, q)));
const lies_in = (facet, away) => facet.every((p) => Math.abs(away(p)) < SAME);
// Puts points of a plane in order about their middle.
function around(points, normal) {
  const middle = [0, 1, 2].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length);
  const x = unit(cross(Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], normal));
  const y = cross(normal, x);
  const angle = (p) => Math.atan2(dot(y, subtract(p, middle)), dot(x, subtract(p, middle)));
  return points.sort((p, q) => angle(p) - angle(q));
}

// A plane through three points, with +y or -y outside.
function through(a, b, c, up) {
  let normal = unit(cross(subtract(b, a), subtract(c, a)));
  if (normal[1] * up < 0) normal = normal.map((k) => -k);
  return [normal, dot(normal, a)];
}
const polar = (radius, y, turn) =>
  [radius * Math.cos(turn * Math.PI / 8), y, radius * Math.sin(turn * Math.PI / 8)];
const rad = Math.PI / 180;

// Returns the planes of a round brilliant of radius 1 (Tolkowsky 1919): eight mains, stars between
// them and sixteen halves above, eight mains and sixteen halves below, and a small culet. It is as
// wide as `stretch` along x.
export function brilliant({ table = 0.56, crown = 34.5, pavilion = 40.75, girdle = 0.05,
  stretch = 1 }) {
  const up = Math.tan(crown * rad), down = Math.tan(pavilion * rad);
  const top = (1 - table) * up, below = -girdle, deep = below - down;
  const planes = [[[0, 1, 0], top], [[0, -1, 0], -(below - 0.985 * down)]];
  for (let k = 0; k < 64; k++) {
    const a = 2 * Math.PI * k / 64;
    planes.push([[Math.cos(a), 0, Math.sin(a)], 1]);
  }
  // The line where two mains meet, at a height.
  const ridge = (y, turn) => polar((1 - y / up) / Math.cos(rad * 22.5), y, turn);
  const keel = (y, turn) => polar((1 - (below - y) / down) / Math.cos(rad * 22.5), y, turn);
  for (let k = 0; k < 8; k++) {
    const a = 2 * k, b = a + 1, c = a + 2;
    planes.push(through(polar(1, 0, a), polar(table, top, a), ridge(0.5 * top, b), 1),
        through(polar(table, top, a), polar(table, top, c), ridge(0.48 * top, b), 1));
    for (const [one, two] of [[a, b], [b, c]]) {
      planes.push(through(polar(1, 0, one), polar(1, 0, two), ridge(0.48 * top, b), 1),
          through(polar(1, below, one), polar(1, below, two), keel(below - 0.77 * down, b), -1));
    }
    planes.push(through(polar(1, below, a), [0, deep, 0], keel(below - 0.5 * down, b), -1));
  }
  return planes.map(([n, d]) => {
    const normal = [n[0] / stretch, n[1], n[2]], size = Math.hypot(...normal);
    return [normal.map((c) => c / size), d / size];
  });
}

// Returns the planes of a step cut (emerald cut) of width 2 and length 2 * `long`: an octagon, rows
// of facets above and below; each row is [steepness in degrees, height of its end].
export function step_cut({ long = 1.35, corner = 0.3, girdle = 0.06,
  above = [[50, 0.13], [40, 0.26], [28, 0.34]], below = [[58, -0.3], [48, -0.62], [40, -1]] }) {
  const planes = [[[0, 1, 0], above.at(-1)[1]]], slant = Math.SQRT1_2;
  for (const [nx, nz, reach] of [[1, 0, long], [-1, 0, long], [0, 1, 1], [0, -1, 1],
    ...[[1, 1], [1, -1], [-1, 1], [-1, -1]].map(([x, z]) =>
      [x * slant, z * slant, (long + 1 - corner) * slant])]) {
    planes.push([[nx, 0, nz], reach]);
    for (const [rows, from, side] of [[above, 0, 1], [below, -girdle, -1]]) {
      let distance = reach, y = from;
      for (const [angle, end] of rows) {
        const [s, c] = [Math.sin(angle * rad), Math.cos(angle * rad)];
        planes.push([[nx * s, side * c, nz * s], s * distance + side * c * y]);
        distance -= Math.abs(end - y) * c / s;
        y = end;
      }
    }
  }
  return planes;
}

export const scale_planes = (planes, size) => planes.map(([normal, d]) => [normal, d * size]);

// Returns the outline of a stone at a height, in order.
export function outline(facets, y) {
  const points = facets.flatMap((facet) => facet.flatMap((p, i) => {
    const q = facet[(i + 1) % facet.length];
    if ((p[1] - y) * (q[1] - y) >= 0) return [];
    const t = (y - p[1]) / (q[1] - p[1]);
    return [[p[0] + (q[0] - p[0]) * t, y, p[2] + (q[2] - p[2]) * t]];
  }));
  return around(apart_all(points), [0, 1, 0]);
}
