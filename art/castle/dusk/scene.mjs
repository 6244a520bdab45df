// SPDX-License-Identifier: Apache-2.0
// What the painting shows: dusk over a valley, a spring among stones, a falcon above it, and a
// second falcon in the sky that a later hand has painted over. x goes from 0 to 1.5, y from 0
// above to 1.
import { clamp, mix, noise, smoothstep } from '../falcon/field.mjs';
import { row_names } from './palette.mjs';

const ROW = Object.fromEntries(row_names.map((name, i) => [name, i]));
const fractal = (x, y, z) =>
  0.55 * noise(x, y, z) + 0.28 * noise(2.1 * x, 2.1 * y, z + 7) +
  0.17 * noise(4.3 * x, 4.3 * y, z + 3);

// A smooth closed line through points.
function smooth(points, steps = 6) {
  return points.flatMap((p1, i) => {
    const at = (k) => points[(i + k + points.length) % points.length];
    const [p0, p2, p3] = [at(-1), at(1), at(2)];
    return Array.from({ length: steps }, (_, s) => {
      const t = s / steps;
      return [0, 1].map((k) => 0.5 * (2 * p1[k] + (p2[k] - p0[k]) * t +
          (2 * p0[k] - 5 * p1[k] + 4 * p2[k] - p3[k]) * t * t +
          (3 * p1[k] - p0[k] - 3 * p2[k] + p3[k]) * t * t * t));
    });
  });
}
function is_inside(loop, x, y) {
  let odd = false;
  for (let i = 0, j = loop.length - 1; i < loop.length; j = i++) {
    const [[xi, yi], [xj, yj]] = [loop[i], loop[j]];
    if ((yi > y) !== (yj > y) && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) odd = !odd;
  }
  return odd;
}

// A falcon that glides, seen from the side and a little below: its beak to the left, about 1 from
// wing tip to wing tip. Loops in the order in which they are painted, later ones over earlier.
const falcon = [
  { part: 'far wing', along: [0.45, -0.9], loop: smooth([[-0.05, -0.03], [0.0, -0.14],
    [0.1, -0.3], [0.24, -0.47], [0.3, -0.53], [0.29, -0.44], [0.25, -0.3], [0.19, -0.17],
    [0.13, -0.06], [0.06, 0.0]]) },
  { part: 'tail', along: [1, 0.2], loop: [[0.1, -0.02], [0.41, 0.05], [0.44, 0.075], [0.4, 0.125],
    [0.1, 0.08]] },
  { part: 'body', along: [1, 0.12], loop: smooth([[-0.22, -0.02], [-0.17, -0.055], [-0.08, -0.06],
    [0.05, -0.045], [0.17, 0.0], [0.2, 0.045], [0.12, 0.085], [0.0, 0.095], [-0.11, 0.075],
    [-0.18, 0.035]]) },
  { part: 'head', along: [1, 0.3], loop: smooth([[-0.275, -0.02], [-0.25, -0.055], [-0.2, -0.062],
    [-0.15, -0.045], [-0.14, 0.0], [-0.18, 0.03], [-0.23, 0.022], [-0.255, 0.005]]) },
  { part: 'beak', along: [1, 0], loop: [[-0.253, -0.025], [-0.285, -0.012], [-0.283, 0.012],
    [-0.262, 0.004]] },
  { part: 'near wing', along: [-0.3, -0.95], loop: smooth([[-0.12, -0.02], [-0.13, -0.15],
    [-0.19, -0.31], [-0.29, -0.47], [-0.4, -0.59], [-0.33, -0.57], [-0.23, -0.48], [-0.13, -0.36],
    [-0.03, -0.22], [0.04, -0.1], [0.06, 0.0], [-0.02, 0.035]]) },
];
const at_home = (bird, x, y) => {
  const dx = (x - bird.x) / bird.size, dy = (y - bird.y) / bird.size;
  const [c, s] = [Math.cos(bird.turn), Math.sin(bird.turn)];
  return [(dx * c + dy * s) * bird.flip, -dx * s + dy * c];
};
const part_at = (bird, x, y) => {
  const [u, v] = at_home(bird, x, y);
  if (Math.abs(u) > 0.5 || Math.abs(v) > 0.65) return undefined;
  const found = falcon.findLast(({ loop }) => is_inside(loop, u, v));
  return found && { ...found, u, v };
};
const BIRD = { x: 0.83, y: 0.37, size: 0.46, turn: -0.1, flip: 1 };
const SECOND = { x: 0.35, y: 0.27, size: 0.44, turn: 0.16, flip: -1 };

function paint_falcon({ part, along, u, v }, bird) {
  const turned = [along[0] * bird.flip, along[1]];
  const [c, s] = [Math.cos(bird.turn), Math.sin(bird.turn)];
  const direction = [turned[0] * c - turned[1] * s, turned[0] * s + turned[1] * c];
  let tone = 0.4;
  const feather = Math.sin(46 * (u * along[1] - v * along[0]) + 3 * noise(9 * u, 9 * v, 1));
  if (part === 'near wing' || part === 'far wing') {
    const out = clamp(-v / 0.55);  // from the shoulder to the tip
    const edge = part === 'near wing' ? u + 0.13 + 0.48 * out : 0.2 - u + 0.22 * out;
    tone = mix(0.44, 0.14, out ** 1.2) + 0.07 * feather +
        0.2 * smoothstep(0.16, 0.0, edge) * (1 - out);
    if (part === 'far wing') tone = tone * 0.7 + 0.3 * smoothstep(0.1, 0.45, out) * 0.55;
    if (Math.sin(58 * out + 5 * u) > 0.86) tone += 0.12;
  } else if (part === 'body') {
    const belly = smoothstep(-0.03, 0.085, v);
    tone = mix(0.3, 0.82, belly) - (Math.sin(95 * u + 30 * v) > 0.55 ? 0.26 : 0) * belly;
    tone += 0.12 * smoothstep(0.02, 0.18, u);
  } else if (part === 'tail') {
    tone = 0.33 + (Math.sin(80 * u) > 0.2 ? 0.17 : -0.1) + 1.2 * (v - 0.05);
  } else if (part === 'head') {
    tone = v > -0.005 ? 0.93 : 0.22;
    if (Math.hypot(u + 0.222, v + 0.02) < 0.0095) tone = 0;
    if (u > -0.215 && u < -0.2 && v > -0.02 && v < 0.028) tone = 0.12;
  } else {
    tone = u < -0.272 ? 0.08 : 0.72;
  }
  return { row: ROW.falcon, tone: clamp(tone), direction };
}

const ridge = (x, at, height, wide, seed) =>
  at - height * (0.5 + 0.5 * fractal(x * wide, seed, 0.3));
const SUN = [1.12, 0.58];

function sky(x, y) {
  const glow = Math.exp(-Math.hypot((x - SUN[0]) * 0.7, (y - SUN[1]) * 1.9) * 2.3);
  const tone = clamp(0.6 * smoothstep(0, 0.66, y) ** 1.25 + 0.62 * glow +
      0.035 * fractal(2.2 * x, 5 * y, 4));
  const layer = (v) => fractal(1.15 * x + 0.6 * v, 15 * v - 1.3 * x, 11) +
      0.12 * noise(9 * x, 60 * v, 4);
  const bands = layer(y) - 0.1 + 0.22 * smoothstep(0.15, 0.5, y) -
      0.75 * smoothstep(0.42, 0.2, Math.hypot(x - 0.35, y - 0.24));
  const slope = 0.05 * noise(2 * x, 3 * y, 2);
  if (bands > 0.2 && y < 0.6) {
    const under = 0.9 * clamp(layer(y) - layer(y + 0.012), -0.1, 0.3);
    return { row: ROW.cloud, direction: [1, slope],
      tone: clamp(0.1 + 0.8 * glow + 0.34 * smoothstep(0.15, 0.55, y) + under -
          0.3 * smoothstep(0.25, 0.6, bands)) };
  }
  return { row: ROW.sky, tone, direction: [1, slope] };
}

// The spring: a pool, and the water that falls into it from a cleft.
const POOL = { x: 0.8, y: 0.835, a: 0.4, b: 0.085 };
const in_pool = (x, y) => {
  const dx = (x - POOL.x) / POOL.a, dy = (y - POOL.y) / POOL.b;
  return 1 - Math.hypot(dx, dy) + 0.1 * noise(7 * x, 7 * y, 9);
};
const stones = [[0.28, 0.73, 0.15, 0.13], [0.43, 0.71, 0.1, 0.12], [0.36, 0.655, 0.11, 0.08],
  [0.53, 0.755, 0.09, 0.065], [0.2, 0.8, 0.12, 0.09], [0.4, 0.87, 0.1, 0.05],
  [0.5, 0.915, 0.1, 0.045], [1.18, 0.8, 0.1, 0.06], [1.28, 0.86, 0.13, 0.07],
  [1.09, 0.9, 0.1, 0.045], [0.74, 0.95, 0.11, 0.04],
  [0.95, 0.955, 0.09, 0.035], [1.07, 0.765, 0.05, 0.028], [0.9, 0.752, 0.045, 0.02]];
function stone_at(x, y) {
  const best = stones.map(([sx, sy, a, b], i) => {
    const dx = (x - sx) / a, dy = (y - sy) / b;
    const rough = 0.22 * noise(9 * x, 9 * y, i) + 0.1 * noise(27 * x, 27 * y, i);
    const depth = 1 - (Math.abs(dx) ** 3 + Math.abs(dy) ** 2.2) ** 0.4 + rough;
    return { dx, dy, i, depth, base: sy };
  }).filter(({ depth }) => depth > 0).sort((p, q) => q.base - p.base)[0];
  if (!best) return undefined;
  const { dx, dy, depth, i } = best;
  // Broken faces: the light jumps from one to the next.
  const face = Math.floor(2.4 * noise(7 * x + 2 * y, 5 * y - 3 * x, i)) / 2.4;
  const light = 0.36 + 0.26 * dx - 0.3 * dy + 0.34 * face + 0.14 * fractal(20 * x, 20 * y, i) +
      0.3 * smoothstep(0.2, 0, depth) * smoothstep(0.1, 0.7, dx - dy);
  const moss = fractal(7 * x, 7 * y, 30 + i) - 0.8 * dy > 0.78;
  return moss ? { row: ROW.meadow, tone: clamp(light * 0.9), direction: [1, 0.4] }
    : { row: ROW.stone, tone: clamp(light), direction: [0.6 + dy, 0.8 * dx + 0.3] };
}
const is_falling = (x, y) => y > 0.7 && y < 0.8 &&
  Math.abs(x - 0.145 - 0.5 * y - 0.006 * noise(40 * y, 1, 1)) < 0.009 + 0.1 * (y - 0.7) ** 1.5;

function water(x, y, depth) {
  // The sky upside down, dark beneath the banks; rings where the water falls in.
  const ripple = 0.012 * Math.sin(140 * Math.hypot(x - 0.55, 3.2 * (y - 0.81)));
  const up = sky(x + ripple, clamp(1.32 - 0.98 * y + ripple, 0, 0.58));
  const bright = up.row === ROW.cloud ? 0.15 + 0.6 * up.tone : up.tone * 0.95 + 0.06;
  const mirrored = part_at({ ...BIRD, y: 1.29, size: BIRD.size * 0.9 }, x + 2 * ripple,
      1.29 - (y - 0.835) * 4.2);
  const bank = smoothstep(0.14, 0.0, depth);
  const ring = Math.hypot(x - 0.55, 3.2 * (y - 0.81));
  const foam = ring < 0.12 && Math.sin(140 * ring) > 0.55 ? 0.3 * (1 - ring / 0.12) : 0;
  return { row: ROW.water, tone: clamp(bright * (1 - 0.75 * bank) + foam - (mirrored ? 0.25 : 0) +
      0.05 * noise(6 * x, 60 * y, 5)), direction: [1, 0.02] };
}

// Trees: the foot and height of each, and clumps of leaves about its stem.
const trees = [[0.1, 0.735, 0.42], [-0.02, 0.77, 0.5], [0.21, 0.71, 0.24], [1.44, 0.74, 0.44],
  [1.36, 0.715, 0.26], [1.53, 0.78, 0.5]].map(([x, foot, high], t) => ({ x, foot, high,
  clumps: Array.from({ length: 9 }, (_, i) => {
    const up = 0.3 + 0.085 * i, wide = high * (0.34 - 0.26 * Math.abs(up - 0.5));
    return [x + wide * noise(3.7 * i, 2.3 * t, 5), foot - high * up, high * (0.15 - 0.07 * up)];
  }) }));
function wood_at(x, y) {
  for (const [t, tree] of trees.entries()) {
    const leaf = 0.028 * fractal(26 * x, 26 * y, 20 + t) + 0.016 * noise(70 * x, 70 * y, t);
    const clump = tree.clumps.find(([cx, cy, r]) => Math.hypot(x - cx, (y - cy) * 1.25) + leaf < r);
    if (clump) {
      const [cx, cy, r] = clump;
      const light = 0.2 + 0.28 * (x - cx) / r - 0.2 * (y - cy) / r + 5 * leaf;
      return { row: ROW.wood, tone: clamp(light * (x < 0.7 ? 1.3 : 0.7)), direction: [0.6, 1] };
    }
    const up = (tree.foot - y) / tree.high;
    const bend = 0.02 * noise(4 * y, t, 2), thick = 0.004 + 0.013 * (1 - up) ** 3;
    if (up > 0 && up < 0.9 && Math.abs(x - tree.x - bend) < thick)
      return { row: ROW.wood, direction: [0, 1],
        tone: x > tree.x + bend + 0.3 * thick ? 0.4 : 0.05 };
  }
  return undefined;
}

// Returns what is seen at a place: a row of the palette, a tone in it, and the way of the brush.
export function see(x, y) {
  const bird = part_at(BIRD, x, y);
  if (bird) return paint_falcon(bird, BIRD);
  if (is_falling(x, y)) return { row: ROW.water, direction: [0.15, 1],
    tone: 0.72 + 0.28 * noise(160 * x, 12 * y, 3) };
  const stone = stone_at(x, y);
  if (stone) return stone;
  const pool = in_pool(x, y);
  if (pool > 0) return water(x, y, pool);
  const wood = wood_at(x, y);
  if (wood) return wood;
  const meadow = ridge(x, 0.72, 0.06, 1.7, 5);
  if (y > meadow) {
    const near = (y - meadow) / (1 - meadow);
    const tuft = fractal(20 * x, 34 * y, 2), flat = fractal(3 * x, 7 * y, 8);
    return { row: ROW.meadow, direction: [0.25 + 0.3 * noise(8 * x, 8 * y, 1), -1],
      tone: clamp(0.62 - 0.5 * near + 0.2 * tuft + 0.2 * flat + 0.18 * (x - 0.75) +
          0.3 * smoothstep(-0.12, 0, pool)) };
  }
  const hill = ridge(x, 0.655, 0.13, 1.15, 2.4) - 0.05 * Math.exp(-(((x - 0.28) / 0.25) ** 2));
  if (y > hill) return { row: ROW.hill, direction: [1, 0.25 * noise(3 * x, 1, 1)],
    tone: clamp(0.12 + 0.35 * (x / 1.5) ** 2 + 3 * (y - hill) + 0.22 * fractal(7 * x, 14 * y, 6) +
        0.35 * smoothstep(0.012, 0, y - hill) * (x / 1.5)) };
  const far = ridge(x, 0.61, 0.12, 2.3, 9.1);
  if (y > far) return { row: ROW.far, direction: [1, 0.1],
    tone: clamp(0.25 + 0.55 * (x / 1.5) ** 2 + 2 * (y - far) + 0.12 * fractal(9 * x, 9 * y, 1)) };
  const above = sky(x, y);
  if (above.row === ROW.sky && part_at(SECOND, x, y)) return { ...above, row: ROW.retouch };
  return above;
}
export { ROW };
