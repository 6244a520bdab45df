#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Writes the castle's case of gems and the prism with its box.
//   node art/castle/gems/make_gems.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit } from 'node:process';
import { glb } from '../falcon/files.mjs';
import { add } from '../falcon/field.mjs';
import { Part, brass, make_case, pane, pbr, plinth } from '../falcon/vitrine.mjs';
import { rgb } from '../spectra/colour.mjs';
import { PATH, transmittance } from '../spectra/gems.mjs';
import { dispersion, index_at } from '../spectra/glass.mjs';
import { brilliant, cut, outline, scale_planes, step_cut } from './cut.mjs';
import { make_prism_file } from './prism.mjs';
import { add_facets, add_lathe, add_tube, place } from './shapes.mjs';

const WIDTH = 0.5, BASE = 1, TOP = 1.52, FLOOR = BASE + 0.02, COLUMN = 0.17, TILT = 0.75;
const round = (value) => Number(value.toFixed(4));

// Each stone is 25 mm long; `half` is half of its width.
const stones = [
  { name: 'Alexandrite', material: 'alexandrite', crystal: 'chrysoberyl', x: -0.075, half: 0.00925,
    planes: step_cut({}) },
  { name: 'Diamond', material: 'diamond', crystal: 'diamond', x: 0, half: 0.0125,
    planes: brilliant({}) },
  { name: 'Ruby', material: 'ruby', crystal: 'corundum', x: 0.075, half: 0.01025,
    planes: brilliant({ stretch: 1.22, crown: 36, pavilion: 42 }) },
];
const MIDDLE = FLOOR + COLUMN + 0.026, FRONT = 0.06;

// Each stone is held by a ring of brass wire below its girdle; three wires go from it to a stem on
// a column of white stone.
function make_stone({ name, material, x, half, planes }, column, wire) {
  const facets = cut(scale_planes(planes, half)), stone = new Part(name, `cut ${material}`);
  add_facets(stone, facets);
  const [s, c] = [Math.sin(TILT), Math.cos(TILT)], axes = [[1, 0, 0], [0, c, s], [0, -s, c]];
  const at = [x, MIDDLE, FRONT], thin = 0.0006;
  place(stone, 0, axes, at);
  const from = wire.points.length, level = -0.25 * half;
  const ring = outline(facets, level).map(([px, py, pz]) => {
    const size = Math.hypot(px, pz);
    return [px * (1 + thin / size), py - thin / 2, pz * (1 + thin / size)];
  });
  add_tube(wire, ring, thin, true, 8);
  const low = Math.min(...facets.flat().map((p) => p[1])), foot = [0, low - 0.0015, 0];
  for (let k = 0; k < 3; k++)
    add_tube(wire, [ring[Math.round((k + 0.5) * ring.length / 3) % ring.length], foot], thin);
  place(wire, from, axes, at);
  const end = add(at, axes[1], foot[1]);
  const top = FLOOR + COLUMN, [px, pz] = [end[0], end[2]];
  add_lathe(wire, [px, pz], [[0.006, top], [0.006, top + 0.0015], [0.0012, top + 0.003],
    [0.0012, end[1] - 0.001], [0.0018, end[1]], [0.0012, end[1] + 0.0012],
    [0, end[1] + 0.0014]], 16);
  add_lathe(column, [px, pz], [[0.03, FLOOR], [0.03, FLOOR + 0.008], [0.022, FLOOR + 0.016],
    [0.015, FLOOR + 0.024], [0.0125, top - 0.03], [0.016, top - 0.018], [0.021, top - 0.012],
    [0.021, top - 0.002], [0.019, top], [0, top]]);
  return stone;
}

// Lamps look down from the lid: a disc that shines for each stone, and small ones around, which the
// facets mirror.
function make_bulbs() {
  const bulbs = new Part('Bulbs Gems', 'gem lamp'), y = TOP - 0.0105, count = 6;
  const disc = (x, z, radius) => add_facets(bulbs, [Array.from({ length: count }, (_, k) => {
    const a = 2 * Math.PI * k / count;
    return [x + radius * Math.cos(a), y, z + radius * Math.sin(a)];
  })]);
  for (const { x } of stones) disc(x, 0.14, 0.011);
  for (const x of [-0.2, -0.1, 0, 0.1, 0.2]) disc(x, -0.1, 0.006);
  for (const x of [-0.19, -0.115, 0.115, 0.19]) disc(x, 0.14, 0.006);
  return bulbs;
}

// A pale panel under the lid, so that the stones have something to send back: their body colour. It
// ends where their tables would mirror it to who looks.
function make_panel() {
  const panel = new Part('Panel Gems', 'gem panel'), w = WIDTH / 2 - 0.03, y = TOP - 0.009;
  add_facets(panel, [[[-w, y, -w], [w, y, -w], [w, y, 0.1], [-w, y, 0.1]]]);
  return panel;
}

// A light shines along -z; each lamp is turned from there to its stone.
function make_lamp({ x }, i) {
  const from = [x, TOP - 0.02, 0.14], to = add([x, MIDDLE, FRONT], from, -1);
  const half = (Math.atan2(to[1], -to[2])) / 2;
  return { name: `Lamp Gems ${i + 1}`, translation: from.map(round),
    rotation: [Math.sin(half), 0, 0, Math.cos(half)].map(round),
    extensions: { KHR_lights_punctual: { light: i } } };
}

// Coloured stones are given no dispersion: theirs is weak beside their colour, and without it light
// of all wavelengths stays together, so that their colour is soon free of noise.
function gem_material({ material, crystal, half }) {
  const red = material === 'diamond' ? [1, 1, 1] : rgb(transmittance(material, PATH));
  return { name: `cut ${material}`, pbrMetallicRoughness: pbr([1, 1, 1], 0), extensions: {
    KHR_materials_transmission: { transmissionFactor: 1 },
    KHR_materials_ior: { ior: round(index_at(crystal, 587.5618)) },
    ...(material === 'diamond'
      ? { KHR_materials_dispersion: { dispersion: round(dispersion(crystal)) } } : {}),
    KHR_materials_volume: { thicknessFactor: 2 * half, ...(material === 'diamond' ? {}
      : { attenuationDistance: PATH,
        attenuationColor: red.map((c) => round(Math.min(Math.max(c, 0.001), 1))) }) } } };
}

const [folder] = argv.slice(2);
if (!folder) {
  console.error('usage: node art/castle/gems/make_gems.mjs FOLDER');
  exit(2);
}
const column = new Part('Gem Columns', 'white marble'), wire = new Part('Gem Settings', 'brass');
const cut_stones = stones.map((stone) => make_stone(stone, column, wire));
writeFileSync(join(folder, 'case.glb'), glb({
  generator: 'art/castle/gems/make_gems.mjs',
  parts: [...make_case('Gems', WIDTH, BASE, TOP, 'night velvet'), column, wire, ...cut_stones,
    make_bulbs(), make_panel()],
  materials: [plinth, brass, pane,
    { name: 'night velvet', pbrMetallicRoughness: pbr([0.012, 0.016, 0.045], 0.9) },
    { name: 'white marble', pbrMetallicRoughness: pbr([0.72, 0.70, 0.66], 0.35) },
    ...stones.map(gem_material),
    { name: 'gem lamp', pbrMetallicRoughness: pbr([0, 0, 0], 1), emissiveFactor: [1, 0.93, 0.82],
      extensions: { KHR_materials_emissive_strength: { emissiveStrength: 60 } } },
    { name: 'gem panel', pbrMetallicRoughness: pbr([0, 0, 0], 1), emissiveFactor: [1, 0.93, 0.82],
      extensions: { KHR_materials_emissive_strength: { emissiveStrength: 6 } } }],
  nodes: stones.map(make_lamp),
  extras: { extensions: { KHR_lights_punctual: { lights: stones.map((_, i) => ({
    name: `Lamp Gems ${i + 1}`, type: 'spot', color: [1, 0.93, 0.82], intensity: 1.1,
    spot: { innerConeAngle: 0.12, outerConeAngle: 0.3 } })) } } },
}));
writeFileSync(join(folder, 'prism.glb'), glb(make_prism_file(brass)));
