// SPDX-License-Identifier: Apache-2.0
// Parts of a glTF file that grow by polygons, and the colours of old stone. Metres, y up.
import { add, clamp, cross, dot, mix, noise, smoothstep, subtract, unit }
  from '../castle/falcon/field.mjs';

const over = (a, b, t) => a.map((c, i) => mix(c, b[i], t));
export const waves = (p, size, turn = 0) => noise(p[0] / size + turn, p[1] / size - turn,
    p[2] / size + 3.1 * turn);

const STONES = [[0.46, 0.385, 0.27], [0.40, 0.355, 0.275], [0.335, 0.315, 0.275],
  [0.45, 0.345, 0.245], [0.50, 0.435, 0.325]];
const MORTAR = [0.40, 0.365, 0.30], DAMP = [0.105, 0.115, 0.075], MOSS = [0.075, 0.115, 0.022];
const SOOT = [0.10, 0.095, 0.085], LICHEN = [0.50, 0.47, 0.35], RUST = [0.45, 0.27, 0.09];

// The colour of a place on stone whose face looks along `normal`; `tone` 0 to 1 is the block's own.
// Near the ground it is damp, where rain lies it has moss, and lichen grows where it is dry.
export function weathered([x, y, z], normal, tone, { mortar = false, ground = 0 } = {}) {
  const p = [x, y, z], n = tone * STONES.length * 0.999, base = STONES[Math.floor(n)];
  let c = mortar ? MORTAR : base.map((one) => one * (0.82 + 0.36 * (n % 1)));
  c = c.map((one) => one * (1 + 0.16 * waves(p, 0.9, 4) + 0.1 * waves(p, 0.21, 9)));
  c = over(c, LICHEN, 0.75 * smoothstep(0.28, 0.55, waves(p, 0.33, 2) + 0.25 * waves(p, 0.07, 5)) *
      smoothstep(0.6, 2.2, y));
  c = over(c, RUST, 0.65 * smoothstep(0.42, 0.62, waves(p, 0.26, 7) + 0.3 * waves(p, 0.06, 1)) *
      smoothstep(0.2, 1.6, y));
  c = over(c, SOOT, 0.6 * smoothstep(0.05, 0.6, noise(2.4 * x, 0.22 * y, 2.4 * z)) *
      smoothstep(2.5, 5.5, y));
  const damp = smoothstep(1.3 + 0.6 * waves(p, 0.8, 3), 0.1, y - ground);
  c = over(c, DAMP, 0.62 * damp);
  const lies = smoothstep(0.45, 0.85, normal[1]) * (0.6 + 0.5 * waves(p, 0.4, 6));
  return over(c, MOSS, clamp(0.9 * lies + 0.5 * damp * smoothstep(0.1, 0.6, waves(p, 0.3, 8))));
}

export class Part {
  constructor(name, material) {
    Object.assign(this, { name, material, points: [], colors: [], uv: [], triangles: [] });
  }
  // Adds a polygon, turned so that it looks away from `inside`, in colours of (place, normal). The
  // picture lies on it from the side that it looks to most.
  face(corners, inside, color, shift = [0, 0]) {
    let normal = [0, 0, 0];
    for (let i = 2; i < corners.length; i++)
      normal = add(normal, cross(subtract(corners[i - 1], corners[0]),
          subtract(corners[i], corners[0])));
    if (dot(normal, normal) < 1e-14) return;
    normal = unit(normal);
    if (inside && dot(normal, subtract(corners[0], inside)) < 0) {
      corners = [...corners].reverse();
      normal = normal.map((c) => -c);
    }
    const steep = normal.map(Math.abs), first = this.points.length;
    const [u, v] = steep[1] > 0.7 ? [0, 2] : steep[0] > steep[2] ? [2, 1] : [0, 1];
    for (const p of corners) {
      this.points.push(p);
      this.colors.push(color(p, normal));
      this.uv.push([p[u] / TILE + shift[0], p[v] / TILE + shift[1]]);
    }
    for (let i = 2; i < corners.length; i++) this.triangles.push([first, first + i - 1, first + i]);
  }
}
export const TILE = 0.9;  // metres that a picture covers

// Adds a block: a box around `at` with worn edges. `axes` are unit vectors, `half` its half sizes.
export function block(part, at, axes, half, random, { wear = 0.016, jitter = 0.006, mortar = false,
  tone = random(), ground = 0 } = {}) {
  const shift = [random(), random()];
  const place = (v) => v.reduce((sum, c, i) => add(sum, axes[i], c), at);
  const corners = new Map();
  for (const x of [-1, 1]) for (const y of [-1, 1]) for (const z of [-1, 1]) {
    const sign = [x, y, z], edge = wear * (0.4 + 1.4 * random());
    const off = half.map(() => jitter * (2 * random() - 1));
    corners.set(sign.join(), [0, 1, 2].map((own) => place(half.map((h, i) =>
      sign[i] * Math.max(i === own ? h : h - edge, 0.2 * h) + off[i]))));
  }
  // Each face has corners of its own; edges and corners between them use these.
  const first = part.points.length, numbers = new Map();
  for (const [sign, three] of corners)
    for (let own = 0; own < 3; own++) {
      const normal = axes[own].map((c) => c * Number(sign.split(',')[own]));
      const steep = normal.map(Math.abs);
      const [u, v] = steep[1] > 0.7 ? [0, 2] : steep[0] > steep[2] ? [2, 1] : [0, 1];
      const p = three[own];
      numbers.set(`${sign},${own}`, part.points.length);
      part.points.push(p);
      part.colors.push(weathered(p, normal, tone, { mortar, ground }));
      part.uv.push([p[u] / TILE + shift[0], p[v] / TILE + shift[1]]);
    }
  const add_face = (...names) => {
    const at_names = names.map((name) => numbers.get(name));
    const [a, b, c] = at_names.map((n) => part.points[n]);
    const turns = dot(cross(subtract(b, a), subtract(c, a)), subtract(a, at)) < 0;
    if (turns) at_names.reverse();
    for (let i = 2; i < at_names.length; i++)
      part.triangles.push([at_names[0], at_names[i - 1], at_names[i]]);
  };
  for (let own = 0; own < 3; own++) {
    const [a, b] = [(own + 1) % 3, (own + 2) % 3];
    const name = (s, p, q, face) => {
      const sign = [0, 0, 0];
      [sign[own], sign[a], sign[b]] = [s, p, q];
      return `${sign},${face}`;
    };
    for (const s of [-1, 1])
      add_face(...[[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([p, q]) => name(s, p, q, own)));
    if (wear > 0) for (const p of [-1, 1]) for (const q of [-1, 1])  // edges along this axis
      add_face(name(-1, p, q, a), name(1, p, q, a), name(1, p, q, b), name(-1, p, q, b));
  }
  if (wear > 0) for (const sign of corners.keys()) add_face(`${sign},0`, `${sign},1`, `${sign},2`);
}

// Adds a rod along a chain of places, eight-sided.
export function rod(part, path, radius, color, sides = 8) {
  const rings = path.map((p, i) => {
    const way = unit(subtract(path[Math.min(i + 1, path.length - 1)], path[Math.max(i - 1, 0)]));
    const side = unit(cross(way, Math.abs(way[1]) > 0.9 ? [1, 0, 0] : [0, 1, 0]));
    const other = cross(way, side), r = typeof radius === 'function' ? radius(i) : radius;
    return Array.from({ length: sides }, (_, k) => {
      const angle = 2 * Math.PI * (k + 0.5) / sides;
      return add(add(p, side, r * Math.cos(angle)), other, r * Math.sin(angle));
    });
  });
  for (let i = 0; i + 1 < path.length; i++)
    for (let k = 0; k < sides; k++)
      part.face([rings[i][k], rings[i][(k + 1) % sides], rings[i + 1][(k + 1) % sides],
        rings[i + 1][k]], add(path[i], subtract(path[i + 1], path[i]), 0.5), color);
  part.face(rings[0], path[1], color);
  part.face(rings.at(-1), path.at(-2), color);
}

// Adds a body of `sides` sides around an upright axis; `profile` lists [radius, height].
export function turned(part, at, profile, sides, color, turn = 0) {
  const ring = ([r, y]) => Array.from({ length: sides }, (_, k) => {
    const angle = 2 * Math.PI * k / sides + turn;
    return [at[0] + r * Math.cos(angle), at[1] + y, at[2] + r * Math.sin(angle)];
  });
  for (let i = 0; i + 1 < profile.length; i++) {
    const a = ring(profile[i]), b = ring(profile[i + 1]);
    // What runs inwards and down is the inside of a basin, and looks to the axis.
    const down = profile[i + 1][1] < profile[i][1];
    for (let k = 0; k < sides; k++) {
      const corners = [a[k], a[(k + 1) % sides], b[(k + 1) % sides], b[k]];
      const middle = corners.reduce((sum, p) => add(sum, p, 0.25), [0, 0, 0]);
      const axis = [at[0], middle[1], at[2]];
      const up = profile[i][0] !== profile[i + 1][0] ? Math.sign(profile[i][0] - profile[i + 1][0])
          : 0;
      const inside = down ? add(middle, subtract(middle, axis), 0.5) : axis;
      part.face(corners, [inside[0], middle[1] - 0.3 * (down ? Math.abs(up) : up), inside[2]],
          color);
    }
  }
}

// Adds a sheet of n x m cells; place(i, k) and color(p, normal). It looks along `way`.
export function sheet(part, n, m, place, way, color) {
  const grid = Array.from({ length: n + 1 }, (_, i) =>
    Array.from({ length: m + 1 }, (__, k) => place(i, k)));
  const first = part.points.length;
  const at = (i, k) => grid[clamp(i, 0, n)][clamp(k, 0, m)];
  for (let i = 0; i <= n; i++) for (let k = 0; k <= m; k++) {
    const p = grid[i][k];
    let normal = unit(cross(subtract(at(i + 1, k), at(i - 1, k)),
        subtract(at(i, k + 1), at(i, k - 1))));
    if (dot(normal, way) < 0) normal = normal.map((c) => -c);
    part.points.push(p);
    part.colors.push(color(p, normal));
    part.uv.push([p[0] / TILE, p[2] / TILE]);
  }
  const turns = dot(cross(subtract(at(1, 0), at(0, 0)), subtract(at(0, 1), at(0, 0))), way) > 0;
  for (let i = 0; i < n; i++) for (let k = 0; k < m; k++) {
    const [a, b, c, d] = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([x, y]) =>
      first + (i + x) * (m + 1) + k + y);
    part.triangles.push(...(turns ? [[a, b, c], [a, c, d]] : [[a, c, b], [a, d, c]]));
  }
}
