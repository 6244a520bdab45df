// SPDX-License-Identifier: Apache-2.0
// The land around the ruin: a meadow, trees, hills, and what visitors find there today: an old door
// in the portal, a desk to read at, and the scanner on its tripod.
import { add, clamp, mix, noise, random, smoothstep } from '../castle/falcon/field.mjs';
import { meadow, PATCH } from './plants.mjs';
import { block, Part, rod, turned } from './shapes.mjs';

const over = (a, b, t) => a.map((c, i) => mix(c, b[i], t));
const GRASS = [0.115, 0.165, 0.042], DRY = [0.27, 0.24, 0.10], WOOD = [0.030, 0.055, 0.020];
const AIR = [0.30, 0.37, 0.46];
const NEAR = 42;  // metres: what is farther has its light in its colours

// What is painted with light in it stands in the sun of content/chapel/exhibit.json, 25 degrees
// high and 128 degrees from -z clockwise, at the exposure of that file.
const SUN = [0.714, 0.4226, 0.558], SUNLIGHT = [1.75, 1.55, 1.2], SKYLIGHT = [0.3, 0.355, 0.43];
const lit = (color, normal, wrap = 0) => {
  const sun = Math.max(0, (normal[0] * SUN[0] + normal[1] * SUN[1] + normal[2] * SUN[2] + wrap) /
    (1 + wrap));
  return color.map((c, i) => c * (SUNLIGHT[i] * sun + SKYLIGHT[i] * (0.6 + 0.4 * normal[1])));
};

function hills(x, z) {
  const r = Math.hypot(x, z), far = smoothstep(45, 200, r);
  const rise = 0.5 + 0.75 * noise(x / 100, z / 100, 31) + 0.3 * noise(x / 36, z / 36, 32);
  // The valley opens to the west, where the sun goes down.
  const open = 1 - 0.75 * smoothstep(0.55, 1, z / (r + 1));
  return far * (5 + 42 * far * Math.max(rise, 0)) * open + 1.2 * smoothstep(20, 70, r) *
    noise(x / 30, z / 30, 33);
}

export function land(x, z) {
  const edge = Math.max(Math.abs(x) / PATCH[0], Math.abs(z) / PATCH[1]);
  return meadow(x, z) + hills(x, z) - 0.6 * (1 - smoothstep(0.84, 0.93, edge));
}

const wooded = (x, z) => smoothstep(0.02, 0.22, noise(x / 44, z / 44, 34) - 0.12 +
  0.35 * smoothstep(80, 170, Math.hypot(x, z)) - 0.7 * smoothstep(60, 36, Math.hypot(x, z)));

function land_color([x, , z], painted) {
  const r = Math.hypot(x, z);
  let c = over(GRASS, DRY, smoothstep(-0.1, 0.7, noise(x / 1.7, z / 1.7, 14) *
    smoothstep(60, 20, r) + 0.6 * noise(x / 24, z / 24, 35)));
  c = over(c, WOOD, wooded(x, z));
  c = c.map((one) => one * (1 + 0.18 * noise(x / (0.4 + r / 60), z / (0.4 + r / 60), 36)));
  if (painted) {
    const d = 0.5 + r / 60, slope = [land(x - d, z) - land(x + d, z), 2 * d,
      land(x, z - d) - land(x, z + d)];
    c = lit(c, slope.map((one) => one / Math.hypot(...slope)));
  }
  return over(c, AIR, 0.4 * smoothstep(60, 260, r));
}

function make_meadow(near, hills_part) {
  const around = 192, radii = [];
  for (let r = 0.5; r < 204; r *= r < 12 ? 1.35 : 1.045) radii.push(r);
  const corner = (i, k) => {
    const angle = 2 * Math.PI * (k % around) / around;
    const [x, z] = [radii[i] * Math.cos(angle), radii[i] * Math.sin(angle)];
    return [x, land(x, z), z];
  };
  const border = radii.findIndex((r) => r > NEAR);
  for (const [part, from, to] of [[near, 0, border], [hills_part, border, radii.length - 1]]) {
    for (let i = from; i <= to; i++) for (let k = 0; k < around; k++) {
      const p = corner(i, k);
      part.points.push(p);
      part.colors.push(land_color(p, part === hills_part));
    }
    for (let i = 0; i < to - from; i++) for (let k = 0; k < around; k++) {
      const [a, b] = [i * around + k, i * around + (k + 1) % around];
      part.triangles.push([a, b, b + around], [a, b + around, a + around]);
    }
  }
}

function leafy(part, centre, radii, count, size, tone, draw, air) {
  for (let i = 0; i < count; i++) {
    let d;
    do d = [2 * draw() - 1, 2 * draw() - 1, 2 * draw() - 1]; while (Math.hypot(...d) > 1);
    const way = d.map((c) => c / Math.hypot(...d)), deep = Math.hypot(...d) ** 0.4;
    const p = centre.map((c, k) => c + way[k] * deep * radii[k]);
    const corner = () => add(p, [draw() - 0.5, draw() - 0.5, draw() - 0.5].map((c) => c * size));
    const light = 0.55 + 0.5 * draw() * deep;
    const color = over(lit(tone.map((c) => c * light), way, 0.35), AIR, air), first = part.points.length;
    part.points.push(corner(), corner(), corner());
    part.colors.push(color, color, color);
    part.triangles.push([first, first + 1, first + 2]);
  }
}

const TONES = [[0.09, 0.135, 0.03], [0.07, 0.115, 0.035], [0.125, 0.15, 0.035],
  [0.055, 0.09, 0.03]];

function tree(leaves, bark, x, z, tall, draw, rich = 1) {
  const y = land(x, z), air = 0.35 * smoothstep(40, 260, Math.hypot(x, z));
  const tone = TONES[Math.floor(4 * draw())], lean = 0.06 * (draw() - 0.5) * tall;
  const brown = over([0.06, 0.048, 0.036], AIR, air);
  rod(bark, [[x, y - 0.3, z], [x + 0.4 * lean, y + 0.25 * tall, z],
    [x + lean, y + 0.6 * tall, z]], (i) => tall * [0.035, 0.024, 0.012][i],
      (p, normal) => lit(brown, normal), 6);
  const clumps = 6 + Math.floor(5 * draw());
  for (let i = 0; i < clumps; i++) {
    const a = 2.4 * i + draw(), share = i / clumps;
    const r = tall * 0.24 * Math.sin(Math.PI * (0.2 + 0.7 * share)) * (0.6 + 0.6 * draw());
    const centre = [x + lean + r * Math.cos(a), y + tall * (0.36 + 0.52 * share),
      z + r * Math.sin(a)];
    const size = tall * (0.13 + 0.07 * draw());
    leafy(leaves, centre, [size, 0.75 * size, size], Math.round(80 * rich), tall * 0.085 / rich **
      0.5, tone, draw, air);
  }
}

function make_trees(leaves, bark) {
  const draw = random(301);
  // Near ones frame the ruin; the others stand where the woods are.
  for (const [x, z, tall] of [[-19, -17, 11], [-25, 6, 9], [21, -24, 12], [27, -9, 8],
    [-13, -30, 10], [9, -34, 13], [-31, -27, 12], [33, 17, 10], [-22, 30, 11], [38, -31, 12]])
    tree(leaves, bark, x, z, tall, draw, 3);
  for (let tries = 0, found = 0; tries < 5000 && found < 150; tries++) {
    const a = 2 * Math.PI * draw(), r = 46 + 150 * draw() ** 1.1;
    const x = r * Math.cos(a), z = r * Math.sin(a);
    if (draw() > wooded(x, z)) continue;
    tree(leaves, bark, x, z, 8 + 7 * draw(), draw, r < 110 ? 0.8 : 0.35);
    found++;
  }
}

function make_blades(part) {
  const draw = random(311);
  for (let n = 0; n < 5200; n++) {
    const a = 2 * Math.PI * draw(), r = 13 + 34 * draw() ** 1.4;
    const x = r * Math.cos(a), z = 1.25 * r * Math.sin(a);
    const edge = Math.max(Math.abs(x) / PATCH[0], Math.abs(z) / PATCH[1]);
    if (edge < 0.86) continue;
    const y = land(x, z), rich = 0.6 + 0.5 * noise(x / 3, z / 3, 22);
    const tone = over(GRASS, DRY, clamp(0.1 + 0.6 * noise(x / 2, z / 2, 22) + 0.3 * draw() - 0.1));
    const wide = 0.007 + r / 5000;
    for (let i = 0; i < 4; i++) {
      const turn = 2 * Math.PI * draw(), high = (0.09 + 0.13 * draw()) * rich, lean = 0.4 * draw();
      const p = [x + 0.16 * (draw() - 0.5), y - 0.02, z + 0.16 * (draw() - 0.5)];
      const side = [-Math.sin(turn) * wide, 0, Math.cos(turn) * wide], first = part.points.length;
      const color = lit(tone.map((c) => c * (0.85 + 0.3 * draw())), [0, 1, 0]);
      part.points.push(add(p, side, -1), add(p, side),
          add(p, [Math.cos(turn) * lean * high, high, Math.sin(turn) * lean * high]));
      part.colors.push(color, color, color);
      part.triangles.push([first, first + 1, first + 2]);
    }
  }
}

// The door leans open at the portal's side: oak that has been out in the rain for long.
function make_door(part, iron) {
  const draw = random(321), turn = 1.15, way = [-Math.cos(turn), 0, Math.sin(turn)];
  const out = [way[2], 0, -way[0]], hinge = [0.93, 0, 8.1];
  for (let i = 0; i < 6; i++) {
    const at = add(add(hinge, way, 0.16 * (i + 0.5)), [0, 1.1, 0]);
    const first = part.points.length;
    block(part, at, [way, [0, 1, 0], out], [0.077, 1.06 - 0.02 * draw(), 0.028], draw,
        { wear: 0.004, jitter: 0.002 });
    const tone = 0.7 + 0.5 * draw();
    for (let n = first; n < part.points.length; n++) {
      const [x, y, z] = part.points[n];
      const c = (0.8 + 0.25 * noise(40 * x + 40 * z, 3 * y, 7)) * tone;
      part.colors[n] = over([0.16, 0.125, 0.09], [0.20, 0.20, 0.17], 0.5 + 0.5 * noise(3 * x, y,
          3 * z)).map((one) => one * c);
    }
  }
  const black = () => [0.035, 0.032, 0.03];
  for (const y of [0.4, 1.75]) {
    const at = (d) => add(add(add(hinge, way, d), out, -0.034), [0, y, 0]);
    rod(iron, [at(0), at(0.3), at(0.62), at(0.8)], (i) => [0.03, 0.022, 0.018, 0.004][i], black, 6);
  }
  const middle = add(add(add(hinge, way, 0.82), out, -0.05), [0, 1.05, 0]);
  const ring = Array.from({ length: 17 }, (_, k) => add(add(middle, way, 0.05 *
    Math.sin(k * Math.PI / 8)), [0, 0.05 * Math.cos(k * Math.PI / 8), 0]));
  rod(iron, ring, 0.007, black, 6);
}

// A reading desk of weathering steel.
function make_desk(part, plate, at, turn) {
  const face = [Math.sin(turn), 0, Math.cos(turn)], right = [face[2], 0, -face[0]];
  const up = [0, Math.cos(0.6), 0], lie = add(up, face, -Math.sin(0.6));
  const normal = [face[0] * Math.cos(0.6), Math.sin(0.6), face[2] * Math.cos(0.6)];
  const draw = random(331), rust = (p) => [0.16, 0.075, 0.04].map((c) => c * (1 + 0.35 *
    noise(p[0] * 25, p[1] * 25, p[2] * 25)));
  rod(part, [add(at, [0, -0.05, 0]), add(at, [0, 0.5, 0]), add(at, [0, 0.95, 0])], 0.03, rust, 4);
  const top = add(at, [0, 0.98, 0]), first = part.points.length;
  block(part, top, [right, lie, normal], [0.25, 0.17, 0.012], draw, { wear: 0.003, jitter: 0 });
  for (let n = first; n < part.points.length; n++) part.colors[n] = rust(part.points[n]);
  const front = add(top, normal, 0.0135), begin = plate.points.length;
  block(plate, front, [right, lie, normal], [0.22, 0.14, 0.002], draw, { wear: 0.001, jitter: 0 });
  for (let n = begin; n < plate.points.length; n++) plate.colors[n] = [0.33, 0.31, 0.26];
  for (let row = 0; row < 9; row++) {
    const wide = row === 0 ? 0.11 : 0.17 - 0.05 * draw() * (row % 3 === 2 ? 2 : 0.2);
    const line = plate.points.length, y = 0.105 - 0.026 * row;
    const centre = add(add(add(front, normal, 0.0022), lie, y), right, -0.19 + wide);
    block(plate, centre, [right, lie, normal], [wide, row === 0 ? 0.009 : 0.004, 0.0005], draw,
        { wear: 0.0002, jitter: 0 });
    for (let n = line; n < plate.points.length; n++) plate.colors[n] = [0.06, 0.05, 0.045];
  }
}

// A laser scanner on its tripod: the head between two forks, with the slit of its mirror.
function make_scanner(part, at) {
  const draw = random(341), dark = () => [0.03, 0.03, 0.032], wood = () => [0.24, 0.16, 0.075];
  const pale = () => [0.34, 0.335, 0.31], amber = () => [0.5, 0.26, 0.02];
  for (let k = 0; k < 3; k++) {
    const a = 2 * Math.PI * k / 3 + 0.4, way = [Math.cos(a), 0, Math.sin(a)];
    const leg = (share, up) => add(add(at, way, share), [0, up, 0]);
    for (const side of [-0.035, 0.035]) {
      const off = [-way[2] * side, 0, way[0] * side];
      rod(part, [add(leg(0.42, 0.25), off, 0.6), add(leg(0.25, 0.72), off), add(leg(0.07, 1.28),
          off, 1.3)], 0.014, wood, 6);
    }
    rod(part, [leg(0.5, 0), leg(0.42, 0.25), leg(0.3, 0.6)], 0.011, dark, 6);
  }
  turned(part, add(at, [0, 1.26, 0]), [[0.1, 0], [0.11, 0.015], [0.11, 0.04], [0.09, 0.05],
    [0.09, 0.075], [0.02, 0.075]], 24, dark);
  turned(part, add(at, [0, 1.335, 0]), [[0.085, 0], [0.1, 0.012], [0.1, 0.05], [0.02, 0.05]], 24,
      amber);
  const axes = [[Math.cos(0.5), 0, Math.sin(0.5)], [0, 1, 0], [-Math.sin(0.5), 0, Math.cos(0.5)]];
  const box = (shift, half, color) => {
    const first = part.points.length;
    const centre = axes.reduce((sum, axis, i) => add(sum, axis, shift[i]), add(at, [0, 1.49, 0]));
    block(part, centre, axes, half, draw, { wear: 0.012, jitter: 0 });
    for (let n = first; n < part.points.length; n++) part.colors[n] = color();
  };
  box([-0.08, 0, 0], [0.034, 0.115, 0.08], pale);
  box([0.08, 0, 0], [0.034, 0.115, 0.08], pale);
  box([0, -0.085, 0], [0.05, 0.025, 0.07], pale);
  box([-0.116, 0.01, 0], [0.003, 0.06, 0.045], dark);
  rod(part, [add(add(at, [0, 1.5, 0]), axes[0], -0.05), add(at, [0, 1.5, 0]), add(add(at, [0, 1.5,
    0]), axes[0], 0.05)], 0.038, dark, 16);
}

export function make_land() {
  const field = new Part('Meadow', 'meadow'), far = new Part('Hills', 'painted');
  const leaves = new Part('Trees', 'leaves');
  const bark = new Part('Trunks', 'leaves'), blades = new Part('Blades', 'leaves');
  const oak = new Part('Door', 'wood'), iron = new Part('Door Iron', 'wood');
  const desk = new Part('Desk', 'steel'), plate = new Part('Desk Plate', 'wood');
  const scanner = new Part('Scanner', 'wood');
  make_meadow(field, far);
  make_trees(leaves, bark);
  make_blades(blades);
  make_door(oak, iron);
  make_desk(desk, plate, [-1.5, 0, -2.5], 0.3);
  make_scanner(scanner, [1.35, 0, -0.4]);
  const parts = [field, far, leaves, bark, blades, oak, iron, desk, plate, scanner];
  for (const part of parts) part.uv = [];
  const rough = (roughnessFactor, metallicFactor = 0) => ({ roughnessFactor, metallicFactor });
  return { parts, materials: [
    { name: 'meadow', pbrMetallicRoughness: rough(1), extensions: { KHR_materials_specular:
      { specularFactor: 0 } } },
    { name: 'painted', pbrMetallicRoughness: rough(1), extensions: { KHR_materials_unlit: {} } },
    { name: 'leaves', pbrMetallicRoughness: rough(1), doubleSided: true,
      extensions: { KHR_materials_unlit: {} } },
    { name: 'wood', pbrMetallicRoughness: rough(0.6) },
    { name: 'steel', pbrMetallicRoughness: rough(0.55) },
  ] };
}
