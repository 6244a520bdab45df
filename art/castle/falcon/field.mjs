// SPDX-License-Identifier: Apache-2.0
// Distances, blends and noise. Millimetres; a distance is negative inside.

export const clamp = (x, low = 0, high = 1) => (x < low ? low : x > high ? high : x);
export const mix = (a, b, t) => a + (b - a) * t;
export const smoothstep = (low, high, x) => {
  const t = clamp((x - low) / (high - low));
  return t * t * (3 - 2 * t);
};

// The lesser of two distances, with a fillet of about `round` where they meet.
export function blend(a, b, round) {
  const h = clamp(0.5 + 0.5 * (b - a) / round);
  return mix(b, a, h) - round * h * (1 - h);
}

function hash(x, y, z) {
  let h = Math.imul(x, 374761393) + Math.imul(y, 668265263) + Math.imul(z, 1442695041);
  h = Math.imul(h ^ (h >>> 13), 1274126177);
  return ((h ^ (h >>> 16)) >>> 0) / 4294967296;
}

// Smooth noise between -1 and 1, with one value for each unit.
export function noise(x, y, z) {
  const i = Math.floor(x), j = Math.floor(y), k = Math.floor(z);
  let u = x - i, v = y - j, w = z - k;
  u *= u * (3 - 2 * u);
  v *= v * (3 - 2 * v);
  w *= w * (3 - 2 * w);
  const low = mix(mix(hash(i, j, k), hash(i + 1, j, k), u),
      mix(hash(i, j + 1, k), hash(i + 1, j + 1, k), u), v);
  const high = mix(mix(hash(i, j, k + 1), hash(i + 1, j, k + 1), u),
      mix(hash(i, j + 1, k + 1), hash(i + 1, j + 1, k + 1), u), v);
  return 2 * mix(low, high, w) - 1;
}

// Numbers from 0 to 1, the same ones for the same seed.
export function random(seed) {
  let state = seed | 0;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

export const add = (a, b, scale = 1) => a.map((c, i) => c + scale * b[i]);
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => {
  const size = length(a) || 1;
  return [a[0] / size, a[1] / size, a[2] / size];
};

// The distance to a chain of rounded cones through [x, y, z, radius].
export function chain(points, x, y, z) {
  let least = Infinity;
  for (let i = 0; i + 1 < points.length; i++) {
    const a = points[i], b = points[i + 1];
    const ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    const px = x - a[0], py = y - a[1], pz = z - a[2];
    const t = clamp((px * ux + py * uy + pz * uz) / (ux * ux + uy * uy + uz * uz || 1));
    const dx = px - t * ux, dy = py - t * uy, dz = pz - t * uz;
    const d = Math.sqrt(dx * dx + dy * dy + dz * dz) - mix(a[3], b[3], t);
    if (d < least) least = d;
  }
  return least;
}

export function ellipsoid(centre, radii, x, y, z) {
  const a = (x - centre[0]) / radii[0], b = (y - centre[1]) / radii[1];
  const c = (z - centre[2]) / radii[2];
  const inside = Math.sqrt(a * a + b * b + c * c);
  const slope = Math.hypot(a / radii[0], b / radii[1], c / radii[2]);
  return slope > 1e-9 ? inside * (inside - 1) / slope : -Math.min(...radii);
}

// The distance to a triangle without thickness.
export function triangle([a, b, c], p) {
  const edges = [[a, b], [b, c], [c, a]];
  const normal = unit(cross(subtract(b, a), subtract(c, a)));
  const within = edges.every(([from, to]) =>
    dot(cross(subtract(to, from), normal), subtract(p, from)) <= 0);
  if (within) return Math.abs(dot(normal, subtract(p, a)));
  return Math.min(...edges.map(([from, to]) => {
    const along = subtract(to, from), out = subtract(p, from);
    return length(add(out, along, -clamp(dot(out, along) / dot(along, along))));
  }));
}

// A smooth line through `points` of any width, with `steps` pieces between two.
export function curve(points, steps = 6) {
  const line = [];
  const at = (i) => points[clamp(i, 0, points.length - 1)];
  for (let i = 0; i + 1 < points.length; i++)
    for (let k = 0; k < steps; k++) {
      const t = k / steps, [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
      line.push(b.map((_, n) => 0.5 * (2 * b[n] + (c[n] - a[n]) * t
          + (2 * a[n] - 5 * b[n] + 4 * c[n] - d[n]) * t * t
          + (3 * b[n] - a[n] - 3 * c[n] + d[n]) * t * t * t)));
    }
  line.push(at(points.length - 1));
  return line;
}
