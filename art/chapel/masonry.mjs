// SPDX-License-Identifier: Apache-2.0
// Walls of courses, pointed arches, ribs and tracery.
import { add, clamp, noise, random } from '../castle/falcon/field.mjs';
import { block, rod, weathered } from './shapes.mjs';

const JOINT = 0.012, FRAME = 0.2;  // metres: between blocks; of the stones around an opening

// Half the width of an opening at a height, `more` metres farther out; 0: it is closed there.
// A pointed arch is of two circles around the opposite springings.
function half_width({ width, sill, spring, round }, y, more) {
  if (round) return Math.sqrt(Math.max(0, (round + more) ** 2 - (y - spring) ** 2));
  if (y < sill - (sill > 0 ? more : 0)) return 0;
  if (y < spring) return width / 2 + more;
  return Math.max(0, Math.sqrt(Math.max(0, (width + more) ** 2 - (y - spring) ** 2)) - width / 2);
}

// Stones along a pointed arch from its left springing (0) over its top (0.5) to the right one (1),
// as far as `parts` say. The arch stands at `at` with `right` along its width; `radius` is at least
// half of that.
export function arch(part, { at, right, half, radius = 2 * half, deep, thick, seed,
  parts = [[0, 1]], stone = 0.3, ground = -9 }) {
  const draw = random(seed), off = radius - half, top = Math.acos(off / radius);
  const out = [right[2], 0, -right[0]], middle = radius + deep / 2;
  const count = Math.max(3, Math.round(middle * top / stone));
  for (const side of [-1, 1])
    for (let i = 0; i < count; i++) {
      const share = (i + 0.5) / count / 2, along = side < 0 ? share : 1 - share;
      const tone = draw();
      if (!parts.some(([from, to]) => along >= from && along <= to)) continue;
      const angle = (i + 0.5) / count * top;
      const away = [Math.cos(angle), Math.sin(angle)];
      const u = side * (middle * away[0] - off), v = middle * away[1];
      const place = add(add(at, right, u), [0, 1, 0], v);
      const radial = [right[0] * side * away[0], away[1], right[2] * side * away[0]];
      const along_arch = [-right[0] * side * away[1], away[0], -right[2] * side * away[1]];
      block(part, place, [along_arch, radial, out],
          [middle * top / count / 2 - JOINT / 3, deep / 2, thick / 2], draw,
          { wear: 0.02, tone, ground });
    }
}

// The stones around an opening.
function surround(part, wall, opening, is_there, draw) {
  const { p, n } = wall.at(opening.centre), right = [n[1], 0, -n[0]];
  const at = (s, y) => [p[0] + right[0] * s, y, p[1] + right[2] * s];
  const thick = wall.thick + 0.05, axes = [right, [0, 1, 0], [n[0], 0, n[1]]];
  if (opening.round) {
    const count = 18;
    for (let i = 0; i < count; i++) {
      const angle = 2 * Math.PI * (i + 0.5) / count, r = opening.round + FRAME / 2;
      const place = at(r * Math.cos(angle), opening.spring + r * Math.sin(angle));
      if (!is_there(opening.centre + r * Math.cos(angle), place[1])) continue;
      block(part, place, [[-right[0] * Math.sin(angle), Math.cos(angle), -right[2] *
        Math.sin(angle)], [right[0] * Math.cos(angle), Math.sin(angle), right[2] *
        Math.cos(angle)], axes[2]], [Math.PI * r / count - JOINT / 2, FRAME / 2, thick / 2], draw);
    }
    return;
  }
  for (const side of [-1, 1])
    for (let y = opening.sill; y < opening.spring - 0.05;) {
      const high = Math.min(0.24 + 0.14 * draw(), opening.spring - y);
      const s = side * (opening.width / 2 + FRAME / 2);
      if (is_there(opening.centre + s, y + high / 2))
        block(part, at(s, y + high / 2), axes, [FRAME / 2, high / 2 - JOINT / 2, thick / 2], draw);
      y += high;
    }
  if (opening.sill > 0 && is_there(opening.centre, opening.sill + 0.3))
    block(part, at(0, opening.sill - FRAME / 2), axes,
        [opening.width / 2 + FRAME, FRAME / 2, thick / 2 + 0.06], draw);
  if (is_there(opening.centre, opening.spring + 0.3))
    arch(part, { at: at(0, opening.spring), right, half: opening.width / 2, deep: FRAME, thick,
      seed: Math.floor(1e6 * draw()), stone: 0.22, parts: opening.parts });
}

// A wall along at(s) = {p: [x, z], n: outwards}, from 0 to `length`; top(s) is the height at which
// it is broken off.
export function masonry(part, core, wall) {
  const draw = random(wall.seed), { at, length, thick, top, openings = [] } = wall;
  const is_there = (s, y) => y < top(s) + 0.35 * noise(2.1 * s, 2.1 * y, wall.seed);
  for (let y = -0.4; y < 11;) {
    const high = 0.27 + 0.17 * draw(), middle = y + high / 2;
    const voids = openings.map((one) => [one.centre, half_width(one, middle, FRAME)])
        .filter(([, half]) => half > 0).map(([c, half]) => [c - half, c + half]);
    for (let s = -0.5 * draw(); s < length;) {
      const from = Math.max(s, 0);
      let to = Math.min(s + 0.42 + 0.6 * draw(), length);
      if (length - to < 0.2) to = length;
      s = to;
      let pieces = [[from, to]];
      for (const [a, b] of voids)
        pieces = pieces.flatMap(([f, t]) => [[f, Math.min(t, a)], [Math.max(f, b), t]])
            .filter(([f, t]) => t - f > 0.05);
      for (const [f, t] of pieces) {
        const centre = (f + t) / 2, tone = draw();
        if (!is_there(centre, middle)) continue;
        const { p, n } = at(centre), right = [n[1], 0, -n[0]], out = [n[0], 0, n[1]];
        const worn = 0.012 * (2 * draw() - 1);
        const place = [p[0] + worn * n[0], middle, p[1] + worn * n[1]];
        const axes = [right, [0, 1, 0], out];
        block(part, place, axes, [(t - f - JOINT) / 2, (high - JOINT) / 2, thick / 2], draw,
            { tone });
        block(core, [p[0], middle, p[1]], axes,
            [(t - f) / 2 + 0.01, high / 2 + 0.005, thick / 2 - 0.022], draw,
            { mortar: true, wear: 0, jitter: 0 });
      }
    }
    y += high;
  }
  for (const opening of openings) surround(part, wall, opening, is_there, draw);
}

// Bars of stone in a pointed window: a mullion, two small arches and a ring, each as far as
// `left` says (0 to 1; 1: all of it).
export function tracery(part, wall, opening, left) {
  const { p, n } = wall.at(opening.centre), right = [n[1], 0, -n[0]];
  const at = (s, y) => [p[0] + right[0] * s, y, p[1] + right[2] * s];
  const color = (q, normal) => weathered(q, normal, 0.92);
  const { width, sill, spring } = opening, half = width / 2, bar = 0.055;
  const bend = (centre, radius, from, to, share) => {
    const steps = Math.max(2, Math.ceil(14 * share)), path = [];
    for (let i = 0; i <= steps; i++) {
      const angle = from + (to - from) * share * i / steps;
      path.push(at(centre[0] + radius * Math.cos(angle), centre[1] + radius * Math.sin(angle)));
    }
    rod(part, path, bar * 0.9, color);
  };
  const low = spring - 0.35;
  if (left.mullion > 0)
    rod(part, [at(0, sill), at(0, sill + 0.5 * (low - sill) * left.mullion),
      at(0, sill + (low - sill) * left.mullion)], bar, color);
  // Small arches: two circles each, of the width of a light.
  for (const side of [-1, 1])
    for (const [share, from] of [[left.inner, 0], [left.outer, 1]]) {
      if (!(share > 0)) continue;
      const centre = from ? 0 : side * half;  // the circle around the opposite springing
      const reach = side * (from ? 1 : -1);
      bend([centre, low], half, reach > 0 ? 0 : Math.PI, reach > 0 ? Math.PI / 3
          : 2 * Math.PI / 3, clamp(share));
    }
  if (left.ring > 0)
    bend([0, spring + 0.3 * width], 0.27 * width, -Math.PI / 2, 1.5 * Math.PI, left.ring);
}
