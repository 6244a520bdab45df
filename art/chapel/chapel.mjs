// SPDX-License-Identifier: Apache-2.0
// The ruin: a nave of 8 x 16 m, an arch to the apse, and what lies and stands in it. The nave's
// middle is at x = 0, z = 0; the apse is in the east, -z, the door in the west, +z.
import { add, clamp, mix, noise, random, smoothstep } from '../castle/falcon/field.mjs';
import { arch, masonry, tracery } from './masonry.mjs';
import { block, rod, sheet, turned, weathered } from './shapes.mjs';

const WALL = 0.9, HALF = 4 + WALL / 2, WEST = 8 + WALL / 2, APSE = { z: -8.4, radius: 3.55 };
const window_of = (centre, width = 1.15, sill = 1.9, spring = 3.7) =>
  ({ centre, width, sill, spring });

// Heights at which walls are broken off, by places along them.
const broken = (steps) => (s) => {
  const i = Math.max(0, steps.findIndex(([at], k) => k + 1 === steps.length ||
    (s >= at && s < steps[k + 1][0])));
  const [a, b] = [steps[i], steps[Math.min(i + 1, steps.length - 1)]];
  return a === b ? a[1] : mix(a[1], b[1], smoothstep(a[0], b[0], s));
};

export const walls = {
  north: { thick: WALL, length: 17.2, seed: 11,
    at: (s) => ({ p: [-HALF, WEST + 0.2 - s], n: [-1, 0] }),
    openings: [window_of(4), window_of(8.6), window_of(13.2)],
    top: broken([[0, 6.1], [2.5, 6.4], [5.6, 6.3], [7.4, 5.0], [9.4, 5.3], [11.2, 6.4],
      [15.5, 6.6]]) },
  south: { thick: WALL, length: 17.2, seed: 23,
    at: (s) => ({ p: [HALF, WEST + 0.2 - s], n: [1, 0] }),
    openings: [window_of(4), window_of(8.6), window_of(13.2)],
    top: broken([[0, 6.0], [2.0, 5.2], [4.5, 2.6], [6.6, 1.1], [9.6, 1.5], [11.0, 3.4],
      [12.2, 5.7], [17, 6.5]]) },
  west: { thick: WALL, length: 8, seed: 37,
    at: (s) => ({ p: [s - 4, WEST], n: [0, 1] }),
    openings: [{ centre: 4, width: 1.9, sill: 0, spring: 2.1 },
      { centre: 4, round: 0.95, spring: 5.9 }],
    top: broken([[0, 6.3], [1.4, 7.6], [3.4, 8.9], [4.1, 8.9], [5.2, 7.1], [6.2, 5.2],
      [8, 4.6]]) },
  chancel: { thick: 0.8, length: 8, seed: 41,
    at: (s) => ({ p: [s - 4, -8.1], n: [0, 1] }),
    openings: [{ centre: 4, width: 5.2, sill: 0, spring: 2.7 }],
    top: broken([[0, 6.4], [1.2, 7.3], [2.8, 8.2], [4.4, 8.5], [5.6, 7.9], [6.4, 7.0],
      [8, 6.5]]) },
  apse: { thick: 0.8, length: Math.PI * APSE.radius, seed: 53,
    at: (s) => {
      const angle = s / APSE.radius, way = [-Math.cos(angle), -Math.sin(angle)];
      return { p: [APSE.radius * way[0], APSE.z + APSE.radius * way[1]], n: way };
    },
    openings: [1, 2, 3].map((i) => window_of(Math.PI * APSE.radius * i / 4, 1.25, 1.6, 3.7)),
    top: broken([[0, 6.0], [3, 5.9], [6.2, 5.7], [7.4, 5.8], [8.8, 5.2], [9.8, 3.6],
      [11, 4.4]]) },
};
walls.west.openings[0].name = 'door';

function ribs(part) {
  const across = { right: [1, 0, 0], half: 4, radius: 4.9, deep: 0.34, thick: 0.42 };
  arch(part, { ...across, at: [0, 3.0, -2.9], seed: 5, parts: [[0, 0.42], [0.9, 1]] });
  arch(part, { ...across, at: [0, 3.0, 2.6], seed: 6, parts: [[0, 0.16]] });
  // Ribs that went to the middle of a vault.
  for (const [z, way, end] of [[-2.9, -1, 0.17], [-2.9, 1, 0.1], [2.6, -1, 0.13], [2.6, 1, 0.08]]) {
    const right = [Math.SQRT1_2, 0, way * Math.SQRT1_2];
    arch(part, { at: [-4 + 5.2 * right[0], 3.0, z + 5.2 * right[2]], right, half: 5.2, radius: 6.2,
      deep: 0.26, thick: 0.24, seed: 7 + Math.round(10 * end), parts: [[0, end]] });
  }
  const color = (p, normal) => weathered(p, normal, 0.71);
  for (const z of [-2.9, 2.6]) for (const side of [-1, 1]) {
    const gone = side > 0 && z > 0;  // this shaft fell with its wall
    const high = gone ? 1.2 : 2.62;
    for (const [dx, dz, r] of [[0, 0, 0.17], [0.02, 0.21, 0.085], [0.02, -0.21, 0.085]])
      turned(part, [side * (3.98 - dx), 0, z + dz], [[r + 0.07, 0], [r + 0.07, 0.16],
        [r + 0.03, 0.24], [r, 0.28], [r, high]], 16, color);
    if (!gone)
      turned(part, [side * 3.98, 2.6, z], [[0.2, 0], [0.24, 0.05], [0.2, 0.1], [0.27, 0.24],
        [0.4, 0.34], [0.42, 0.42], [0.02, 0.42]], 16, color);
  }
}

const step_up = -7.4, chancel_floor = 0.3;
// The height of the floor, also where slabs are missing.
export const floor_height = (x, z) => (z < step_up - 0.35 ? chancel_floor : z < step_up ? 0.15 : 0);
export const is_inside = (x, z, more = 0) => (Math.abs(x) < 4 + more && z > -8.2 && z < 8 + more) ||
  (z <= -8.2 && Math.hypot(x, z - APSE.z) < APSE.radius - 0.4 + more);
export const has_slab = (x, z) =>
  noise(0.55 * x, 0.55 * z, 71) + 0.5 * noise(1.7 * x, 1.7 * z, 72) < 0.36 ||
  Math.abs(x - 0.1) < 0.55;

function slabs(part) {
  const draw = random(61), axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let z = -11.8; z < 7.95;) {
    const deep = 0.55 + 0.4 * draw();
    for (let x = -4 - 0.5 * draw(); x < 4;) {
      const wide = 0.5 + 0.55 * draw(), at = [x + wide / 2, z + deep / 2];
      x += wide;
      const tone = draw(), tilt = [0.02 * (draw() - 0.5), 0.02 * (draw() - 0.5)], lower = draw();
      if (!is_inside(...at, -0.12) || !has_slab(...at)) continue;
      const left = Math.max(at[0] - wide / 2, -3.98), right = Math.min(at[0] + wide / 2, 3.98);
      const up = [tilt[0], 1, tilt[1]];
      block(part, [(left + right) / 2, floor_height(...at) - 0.06 - 0.012 * lower, at[1]],
          [axes[0], up, axes[2]], [(right - left) / 2 - 0.008, 0.06, deep / 2 - 0.008], draw,
          { wear: 0.014, tone, ground: floor_height(...at) - 0.75 });
    }
    z += deep;
  }
  // Steps to the apse.
  for (const [z, y] of [[step_up, 0.15], [step_up - 0.35, 0.3]])
    for (let x = -3.9; x < 3.9;) {
      const wide = Math.min(0.8 + 0.5 * draw(), 3.95 - x);
      block(part, [x + wide / 2, y - 0.09, z - 0.2], axes, [wide / 2 - 0.006, 0.09, 0.2], draw,
          { ground: -0.4, wear: 0.03 });
      x += wide;
    }
}

// The height of what is carved on the tomb's lid, metres; u to its side, v to its head, from its
// middle: a falcon on a shield, a cross with a long shaft, and a border of letters.
function carving(u, v) {
  const line = (x, y, ax, ay, bx, by) => {
    const t = clamp(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) /
      ((bx - ax) ** 2 + (by - ay) ** 2));
    return Math.hypot(x - ax - t * (bx - ax), y - ay - t * (by - ay));
  };
  const ridge = (d, r, high) => high * (1 - smoothstep(0.55 * r, r, d));
  const edge = Math.min(0.43 - Math.abs(u), 0.98 - Math.abs(v));
  let h = 0.02 * smoothstep(0.1, 0.075, edge) - 0.014 * smoothstep(0.012, 0, edge);
  // Letters: strokes by chance, a hand high, along the border.
  const side = 0.43 - Math.abs(u) < 0.98 - Math.abs(v);
  const along = side ? v : u, across = side ? 0.43 - Math.abs(u) : 0.98 - Math.abs(v);
  const letter = Math.floor(along / 0.045), within = along / 0.045 - letter - 0.5;
  const kind = noise(letter * 3.7 + 0.5, side ? Math.sign(u) * 9.2 : Math.sign(v) * 5.1, 8.5);
  if (across > 0.02 && across < 0.072) {
    const y = (across - 0.046) / 0.026;
    const d = Math.min(Math.abs(within + 0.22), kind > 0 ? Math.abs(within - 0.22) : 9,
        kind < 0.2 ? Math.abs(y - 0.8) * 0.5 + 0.02 : 9, kind < -0.1 ? Math.abs(y) * 0.5 : 9,
        Math.abs(kind) < 0.3 ? Math.abs(within - 0.4 * y) : 9);
    h -= 0.006 * (1 - smoothstep(0.05, 0.12, d));
  }
  // The cross.
  h = Math.max(h, ridge(line(u, v, 0, -0.72, 0, 0.62), 0.034, 0.026));
  h = Math.max(h, ridge(line(u, v, -0.2, 0.52, 0.2, 0.52), 0.034, 0.026));
  h = Math.max(h, ridge(Math.abs(Math.hypot(u, v - 0.52) - 0.15), 0.026, 0.022));
  for (const [x, y] of [[-0.22, 0.52], [0.22, 0.52], [0, 0.74]])
    for (const turn of [-0.7, 0, 0.7])
      h = Math.max(h, ridge(Math.hypot(u - x - 0.035 * Math.sin(turn) * (y > 0.6 ? 1 : 0) -
        0.035 * Math.sign(x) * Math.cos(turn), v - y - 0.035 * Math.sin(turn) -
        (x === 0 ? 0.03 * Math.cos(turn) : 0)), 0.03, 0.028));
  for (const [y, w] of [[-0.72, 0.13], [-0.78, 0.19]])
    h = Math.max(h, ridge(line(u, v, -w, y, w, y), 0.03, 0.024));
  // The shield with the falcon, over the shaft.
  const sy = v + 0.16, half = 0.17 * Math.sqrt(clamp(1 - clamp((-sy - 0.02) / 0.22) ** 2));
  const shield = Math.min(half - Math.abs(u), 0.2 - sy, sy + 0.235);
  if (shield > -0.012) {
    h = mix(h, 0.022, smoothstep(-0.012, 0.004, shield));
    h = Math.max(h, 0.022 + ridge(Math.abs(shield - 0.012), 0.011, 0.012));
    const bird = Math.min(line(u, sy, 0, 0.1, 0, -0.06) - 0.02, line(u, sy, 0, -0.06, 0, -0.13),
        line(u, sy, 0.02, 0.1, 0.045, 0.092) + 0.008,
        ...[-1, 1].flatMap((s) => [0, 1, 2, 3].map((i) =>
          line(u, sy, s * 0.02, 0.06, s * (0.12 - 0.018 * i), 0.1 - 0.055 * i) + 0.002 * i)));
    h = Math.max(h, 0.022 + ridge(bird, 0.02, 0.014));
  }
  // A crack across, and worn places.
  h -= 0.012 * (1 - smoothstep(0.004, 0.009, Math.abs(v - 0.2 - 0.3 * u -
    0.03 * noise(9 * u, 3, 1))));
  return h + 0.0025 * noise(14 * u, 14 * v, 5) - 0.004 * smoothstep(0.1, 0.6,
      noise(4 * u, 4 * v, 9));
}

function tomb(part) {
  const at = [-1.75, 0, -4.3], draw = random(83), axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  block(part, add(at, [0, 0.06, 0]), axes, [0.62, 0.06, 1.18], draw, { tone: 0.5, ground: -0.4 });
  for (const [x, z, a, c] of [[-0.4, 0, 0.06, 0.95], [0.4, 0, 0.06, 0.95], [0, -0.9, 0.4, 0.06],
    [0, 0.9, 0.4, 0.06]])
    block(part, add(at, [x, 0.32, z]), axes, [a, 0.21, c], draw, { tone: 0.55, ground: -0.4 });
  // Blind arches on its sides.
  for (const side of [-1, 1]) for (let i = -3; i < 3; i++)
    arch(part, { at: add(at, [side * 0.465, 0.36, 0.3 * (i + 0.5)]), right: [0, 0, 1], half: 0.1,
      deep: 0.03, thick: 0.035, seed: 90 + i, stone: 0.05 });
  block(part, add(at, [0, 0.565, 0]), axes, [0.5, 0.045, 1.05], draw,
      { tone: 0.9, ground: -1, wear: 0.02 });
  const color = (p, normal) => {
    const c = weathered(p, [normal[0], 0.3 * normal[1], normal[2]], 0.93, { ground: -1 });
    const hollow = clamp(0.75 + 12 * (p[1] - 0.615), 0.55, 1.1);
    return c.map((one) => one * hollow);
  };
  sheet(part, 116, 264, (i, k) => {
    const u = -0.43 + 0.86 * i / 116, v = -0.98 + 1.96 * k / 264;
    return [at[0] + u, 0.614 + carving(u, -v), at[2] + v];
  }, [0, 1, 0], color);
}

function font(part) {
  const at = [1.9, 0, 4.6], color = (p, normal) => weathered(p, normal, 0.97, { ground: -0.3 });
  const turn = Math.PI / 8;
  turned(part, at, [[0.62, 0], [0.62, 0.14], [0.5, 0.14], [0.5, 0.26], [0.42, 0.3]], 8, color, turn);
  turned(part, add(at, [0, 0.26, 0]), [[0.3, 0], [0.24, 0.06], [0.22, 0.3], [0.28, 0.36],
    [0.46, 0.46], [0.47, 0.78], [0.5, 0.8], [0.5, 0.86], [0.38, 0.86], [0.34, 0.66],
    [0.02, 0.58]], 8, color, turn);
  for (let k = 0; k < 8; k++) {
    const angle = Math.PI * k / 4 + Math.PI / 4, way = [Math.cos(angle), 0, Math.sin(angle)];
    const right = [-way[2], 0, way[0]], middle = add(add(at, way, 0.435), [0, 0.86, 0]);
    for (let i = 0; i < 4; i++) {  // a quatrefoil
      const centre = add(add(middle, right, 0.05 * Math.cos(Math.PI * i / 2)), [0, 1, 0],
          0.05 * Math.sin(Math.PI * i / 2)), path = [];
      for (let n = 0; n <= 10; n++) {
        const a = Math.PI * (i / 2 + (n / 10 - 0.5) * 1.5);
        path.push(add(add(centre, right, 0.055 * Math.cos(a)), [0, 1, 0], 0.055 * Math.sin(a)));
      }
      rod(part, path, 0.014, color, 6);
    }
  }
}

// Two stones on which the capital stands that was found beneath them.
function plinth(part) {
  const draw = random(151), turn = 0.12;
  const axes = [[Math.cos(turn), 0, Math.sin(turn)], [0, 1, 0], [-Math.sin(turn), 0, Math.cos(turn)]];
  block(part, [-2.3, 0.2, 1.7], axes, [0.4, 0.2, 0.38], draw, { wear: 0.03, ground: -0.5 });
  block(part, [-2.31, 0.59, 1.69], axes, [0.33, 0.19, 0.34], draw,
      { wear: 0.03, tone: 0.93, ground: -0.5 });
}

// Stones that fell: by walls that are gone, and a drum of a shaft.
function fallen(part, ground) {
  const draw = random(97);
  const heap = (x, z, spread, count, size = 1) => {
    for (let i = 0; i < count; i++) {
      const angle = 2 * Math.PI * draw(), r = spread * Math.sqrt(draw());
      const px = x + r * Math.cos(angle), pz = z + 1.6 * r * Math.sin(angle);
      const a = 2 * Math.PI * draw(), b = 0.5 * (draw() - 0.5), c = 0.4 * (draw() - 0.5);
      const [s, t] = [Math.sin(a), Math.cos(a)];
      const up = [b, 1, c].map((one) => one / Math.hypot(1, b, c));
      const right = [t, -t * b, s], out = [-s, 0, t];
      const half = [0.1 + 0.2 * draw(), 0.07 + 0.09 * draw(), 0.1 + 0.13 * draw()]
          .map((one) => one * size);
      const lift = 0.5 * (1 - r / spread) * Math.min(1, count / 40) * draw();
      const y = ground(px, pz) + half[1] * 0.55 + lift;
      block(part, [px, y, pz], [right, up, out], half, draw,
          { wear: 0.035, jitter: 0.02, ground: ground(px, pz) - 0.5 });
    }
  };
  heap(5.6, 1.4, 2.0, 80);
  heap(3.3, 0.9, 1.1, 34, 0.9);
  heap(6.8, 3.0, 1.6, 26);
  heap(-3.3, 0.4, 0.7, 12, 0.8);
  heap(2.6, 9.6, 1.5, 24);
  heap(3.3, -10.6, 0.8, 16);
  heap(-5.9, -4, 1.4, 14);
  heap(-2.4, 6.4, 0.8, 9);
  heap(0.9, -2.6, 0.9, 11, 1.1);
  const color = (p, normal) => weathered(p, normal, 0.71);
  for (const [x, z, turn] of [[2.7, 2.2, 0.5], [2.2, 3.1, 1.9]]) {
    const way = [Math.cos(turn), 0.04, Math.sin(turn)], at = [x, 0.14, z];
    rod(part, [0, 0.03, 0.64, 0.68].map((d) => add(at, way, d)),
        (i) => (i === 0 || i === 3 ? 0.15 : 0.17), color, 16);
  }
}

export function build(stone, core, ground) {
  for (const wall of Object.values(walls)) masonry(stone, core, wall);
  const openings = walls.apse.openings;
  tracery(stone, walls.apse, openings[1], { mullion: 1, inner: 1, outer: 1, ring: 1 });
  tracery(stone, walls.apse, openings[0], { mullion: 1, inner: 0.5, outer: 0.75, ring: 0 });
  tracery(stone, walls.apse, openings[2], { mullion: 0.35, inner: 0, outer: 0.6, ring: 0 });
  tracery(stone, walls.north, walls.north.openings[2], { mullion: 1, inner: 1, outer: 1,
    ring: 0.7 });
  tracery(stone, walls.north, walls.north.openings[0], { mullion: 0.45, inner: 0, outer: 0.5,
    ring: 0 });
  tracery(stone, walls.south, walls.south.openings[2], { mullion: 0, inner: 0, outer: 0.8,
    ring: 0 });
  ribs(stone);
  slabs(stone);
  tomb(stone);
  font(stone);
  plinth(stone);
  fallen(stone, ground);
  // Buttresses, in two steps.
  const draw = random(113), axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (const side of [-1, 1]) for (const [z, top] of [[6.4, 4.4], [2.2, side < 0 ? 4.2 : 0.8],
    [-2.4, side < 0 ? 4.4 : 3.2], [-7, 4.6]])
    for (let y = -0.3; y < top;) {
      const high = 0.26 + 0.12 * draw(), deep = y < 2 ? 0.45 : 0.3;
      const x = side * (4.9 + deep - 0.06);
      for (const half of [-1, 1])
        block(stone, [x, y + high / 2, z + 0.21 * half], axes, [deep, high / 2 - 0.006, 0.2], draw);
      y += high;
    }
}
