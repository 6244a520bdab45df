// SPDX-License-Identifier: Apache-2.0
// The castle's gems are closed bodies, the alexandrite changes its colour, and the sun of the
// exhibit's own hour goes through the prism to the middle of the card.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import { cross, dot, subtract, unit } from '../../art/castle/falcon/field.mjs';
import { LAMPS, lab } from '../../art/castle/spectra/colour.mjs';
import { PATH, transmittance } from '../../art/castle/spectra/gems.mjs';
import { index_at } from '../../art/castle/spectra/glass.mjs';
import { SUN, find_card, leaves_at, trace_prism } from '../../art/castle/gems/prism.mjs';

const castle = join(process.env.WELLSPRING_SOURCE, 'content/castle');
function read_glb(name) {
  const file = readFileSync(join(castle, name)), size = file.readUInt32LE(12);
  const document = JSON.parse(file.toString('utf8', 20, 20 + size)), begin = 28 + size;
  const view = ({ bufferView }) => begin + document.bufferViews[bufferView].byteOffset;
  // Returns the triangles of a node's mesh as triples of corners.
  const triangles = (wanted) => {
    const { mesh } = document.nodes.find(({ name: node }) => node === wanted);
    const { attributes, indices } = document.meshes[mesh].primitives[0];
    const [points, order] = [attributes.POSITION, indices].map((at) => document.accessors[at]);
    assert.equal(order.componentType, 5123);
    const corner = (i) => [0, 1, 2].map((k) => file.readFloatLE(view(points) + 12 *
        file.readUInt16LE(view(order) + 2 * i) + 4 * k));
    return Array.from({ length: order.count / 3 }, (_, t) =>
      [0, 1, 2].map((k) => corner(3 * t + k)));
  };
  return { document, triangles };
}

for (const [file, name] of [['case', 'Alexandrite'], ['case', 'Ruby'], ['case', 'Diamond'],
  ['prism', 'Prism']])
  test(`${name} is closed, convex and faces outwards`, () => {
    const all = read_glb(`gems/${file}.glb`).triangles(name), edges = new Map();
    const key = (p) => p.map((c) => Math.round(c * 2e6)).join();
    for (const corners of all)
      corners.forEach((p, i) => {
        const edge = `${key(p)} ${key(corners[(i + 1) % 3])}`;
        assert.ok(!edges.has(edge), `${edge} twice`);
        edges.set(edge, true);
      });
    for (const edge of edges.keys()) {
      const [a, b] = edge.split(' ');
      assert.ok(edges.has(`${b} ${a}`), `open at ${edge}`);
    }
    const points = all.flat();
    for (const [a, b, c] of all) {
      const normal = unit(cross(subtract(b, a), subtract(c, a)));
      for (const p of points)
        assert.ok(dot(normal, subtract(p, a)) < 3e-5, `${name} is dented at ${a}`);
    }
    const long = Math.max(...points.map((p) => Math.max(...points.map((q) =>
      Math.hypot(...subtract(p, q))))));
    assert.ok(file === 'prism' || (long > 0.012 && long < 0.031), `${name} is ${long} m long`);
  });

test('the alexandrite is green by day and red by candle, the ruby always red', () => {
  const seen = (gem, lamp) => {
    const [, a, b] = lab(transmittance(gem, PATH), LAMPS[lamp]);
    return { hue: (Math.atan2(b, a) * 180 / Math.PI + 360) % 360, chroma: Math.hypot(a, b) };
  };
  const day = seen('alexandrite', 'north-light'), night = seen('alexandrite', 'candle');
  assert.ok(day.hue > 150 && day.hue < 200 && day.chroma > 20, JSON.stringify(day));
  assert.ok(night.hue > 320 && night.hue < 360 && night.chroma > 20, JSON.stringify(night));
  for (const lamp of ['north-light', 'candle', 'A']) {
    const { hue, chroma } = seen('ruby', lamp);
    assert.ok((hue > 340 || hue < 40) && chroma > 30, `${lamp} ${hue} ${chroma}`);
  }
});

test('indices of refraction are those of tables', () => {
  for (const [name, nm, expected] of [['F2', 587.56, 1.62004], ['N-BK7', 587.56, 1.5168],
    ['diamond', 589.3, 2.4173], ['corundum', 589.3, 1.7681], ['chrysoberyl', 589.3, 1.7483]])
    assert.ok(Math.abs(index_at(name, nm) - expected) < 5e-4, `${name} ${index_at(name, nm)}`);
});

// Follows a ray through the prism's triangles by Snell's law.
function follow(triangles, from, direction, index) {
  let [at, way, inside] = [from, direction, false];
  for (let round = 0; round < 2; round++) {
    const hit = triangles.map(([a, b, c]) => {
      const normal = unit(cross(subtract(b, a), subtract(c, a))), along = dot(normal, way);
      const t = dot(normal, subtract(a, at)) / along;
      const p = at.map((x, k) => x + t * way[k]);
      const left = [[a, b], [b, c], [c, a]].every(([p0, p1]) =>
        dot(cross(subtract(p1, p0), subtract(p, p0)), normal) > -1e-9);
      return { t, p, normal, hits: left && t > 1e-6 && (along < 0) !== inside };
    }).filter(({ hits }) => hits).sort((p, q) => p.t - q.t)[0];
    assert.ok(hit, 'the ray misses the prism');
    const n = inside ? index : 1 / index, facing = hit.normal.map((c) => (inside ? -c : c));
    const cosine = -dot(facing, way), root = 1 - n * n * (1 - cosine * cosine);
    assert.ok(root > 0, 'the ray stays in the prism');
    [at, way, inside] = [hit.p, way.map((c, k) => n * c + (n * cosine - Math.sqrt(root)) *
        facing[k]), !inside];
  }
  return { at, way };
}

test('the sun of the own hour goes through the prism to the card, red below violet', () => {
  const { document } = read_glb('scene.glb');
  const [x, y, z, w] = document.nodes.find(({ name }) => name === 'Sun').rotation;
  const sun = [-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))];
  for (const k of [0, 1, 2]) assert.ok(Math.abs(sun[k] - SUN[k]) < 1e-5, `${sun} ${SUN}`);
  const { middle, inside, leaves } = trace_prism(), { at: card, axes } = find_card();
  const prism = read_glb('gems/prism.glb').triangles('Prism');
  const height = (nm) => {
    const ray = follow(prism, middle.map((c, k) => c - 0.2 * SUN[k]), SUN, index_at('F2', nm));
    assert.ok(Math.abs(Math.asin(ray.way[1]) - leaves_at(nm)) < 1e-4, `${nm}`);
    // The card leans between the box's x and z.
    const normal = axes[2].map((c, k) => c - axes[0][k]);
    const t = dot(normal, subtract(card, ray.at)) / dot(normal, ray.way);
    const off = subtract(ray.at.map((c, k) => c + t * ray.way[k]), card);
    assert.ok(Math.abs(dot(off, axes[0])) < 0.02, `${nm} beside the card by ${off}`);
    return dot(off, axes[1]);
  };
  assert.ok(Math.abs(height(560)) < 0.01, `${height(560)}`);
  const [red, blue] = [height(656), height(440)];
  assert.ok(red < -0.02 && red > -0.15 && blue > 0.05 && blue < 0.15, `${red} ${blue}`);
  // It is bent as little as it can be: as much before the middle as behind it.
  assert.ok(Math.abs((Math.asin(SUN[1]) + leaves) / 2 - inside) < 1e-6);
});

test('the sun reaches the prism between the lead of the window', () => {
  const { middle } = trace_prism();
  // The lattice's lines and the window as art/castle/scripts/hall.py has them.
  const [window, sill, cell, slope, lead] = [-2, 1.15, 0.21, 1.45, 0.0065];
  for (const side of [-0.05, 0.05])
    for (const up of [-0.011, 0.011]) {
      const from = [middle[0] + side * 0.883, middle[1] + up, middle[2] + side * 0.469];
      const t = (from[2] + 4.72) / SUN[2];
      const [x, y] = [from[0] - t * SUN[0] - window, from[1] - t * SUN[1] - sill];
      for (const sign of [-1, 1]) {
        const lines = (y - sign * slope * x) / (slope * cell);
        const away = Math.abs(lines - Math.round(lines)) * slope * cell / Math.hypot(1, slope);
        assert.ok(away > lead, `${side} ${up}: ${away} m from the lead's middle`);
      }
    }
});
