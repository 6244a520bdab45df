// SPDX-License-Identifier: Apache-2.0
// Writes paths, colours and items of paintings. Numbers are rounded: files are small, and the same
// on all machines.

// Returns a source of numbers from 0 to 1 (mulberry32); the same seed gives the same numbers.
export function random_source(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

export const round = (x, digits = 5) => Number(x.toFixed(digits));
const point = ([x, y], digits) => `${round(x, digits)} ${round(y, digits)}`;

// Returns paths through points: with corners, or smooth; `closed` ends where it began.
export const line = (points, digits = 5) =>
  `M${point(points[0], digits)}L${points.slice(1).map((p) => point(p, digits)).join(' ')}`;
export const polygon = (points, digits = 5) => `${line(points, digits)}Z`;
export const curve = (points, digits = 5) =>
  `M${point(points[0], digits)}R${points.slice(1).map((p) => point(p, digits)).join(' ')}`;
export const shape = (points, digits = 5) => `${curve(points, digits)}Z`;

// Returns a closed shape whose upper edge runs smoothly through points, down to `bottom`.
export const ground = (edge, bottom, digits = 5) =>
  `${curve(edge, digits)}L${round(edge.at(-1)[0])} ${bottom} ${round(edge[0][0])} ${bottom}Z`;

// Returns points of a ridge from x0 to x1 around y, rough on several scales.
export function ridge(random, x0, x1, y, height, parts, roughness = 0.5) {
  let points = [[x0, y - height * random()], [x1, y - height * random()]];
  let swing = height;
  while (points.length < parts) {
    const finer = [points[0]];
    for (let i = 1; i < points.length; i++) {
      const [a, b] = [points[i - 1], points[i]];
      finer.push([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2 + swing * (random() - 0.55)], b);
    }
    points = finer, swing *= roughness;
  }
  return points;
}

// Returns a closed wavy shape around a place.
export function blob(random, x, y, rx, ry, count = 10, wave = 0.25, digits = 5) {
  const points = [];
  for (let i = 0; i < count; i++) {
    const turn = 2 * Math.PI * (i + 0.4 * random()) / count, far = 1 - wave * random();
    points.push([x + rx * far * Math.cos(turn), y + ry * far * Math.sin(turn)]);
  }
  return shape(points, digits);
}

// Collects what a painting's file holds.
export class Sheet {
  constructor(head) {
    this.file = { ...head, gradients: {}, brushes: {}, symbols: [], layers: [] };
    this.known = new Map();
  }
  // Each returns the name by which items refer to a gradient; stops are [place, colour, ...].
  linear(x0, y0, x1, y1, ...stops) {
    return this.gradient({ from: [round(x0), round(y0)], to: [round(x1), round(y1)] }, stops);
  }
  radial(x, y, radius, ...stops) {
    return this.gradient({ from: [round(x), round(y)], radius: round(radius) }, stops);
  }
  gradient(frame, flat) {
    const stops = [];
    for (let i = 0; i < flat.length; i += 2) stops.push({ at: flat[i], color: flat[i + 1] });
    const value = { ...frame, stops }, key = JSON.stringify(value);
    if (!this.known.has(key)) {
      const name = `g${this.known.size}`;
      this.known.set(key, name);
      this.file.gradients[name] = value;
    }
    return `@${this.known.get(key)}`;
  }
  brush(name, width_mm, length_mm, given = {}) {
    const { smear_mm = 0, ...rest } = given;
    this.file.brushes[name] =
      { width: width_mm / 1000, length: length_mm / 1000, smear: smear_mm / 1000, ...rest };
  }
  symbol(name, items, brush) {
    this.file.symbols.push({ name, items, ...(brush && { brush }) });
    return name;
  }
  layer(name, ground, material, items, more = {}) {
    this.file.layers.push({ name, ground, material, items, ...more });
  }
}

// Items.
export const fill = (path, color, more = {}) => ({ path, fill: color, ...more });
export const stroke = (path, color, width, more = {}) =>
  ({ path, stroke: color, width: round(width, 6), ...more });
export const oval = (x, y, rx, ry, color, more = {}) =>
  ({ ellipse: [x, y, rx, ry].map((n) => round(n)), fill: color, ...more });
export const box = (x0, y0, x1, y1, color, more = {}) =>
  ({ box: [x0, y0, x1, y1].map((n) => round(n)), fill: color, ...more });
export const use = (include, x, y, scale, more = {}) =>
  ({ include, move: [round(x), round(y)], scale: Array.isArray(scale) ?
    scale.map((n) => round(n, 6))
    : round(scale, 6), ...more });
export const sow = (repeat, within, cell, scale, more = {}) =>
  ({ repeat, within, cell: round(cell, 6), scale: scale.map((n) => round(n, 6)), ...more });
export const words = (text, x, y, size, color, more = {}) =>
  ({ text, at: [round(x), round(y)], size: round(size, 6), fill: color, ...more });
