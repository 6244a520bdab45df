// SPDX-License-Identifier: Apache-2.0
// The platform of a tower by night: a parapet with merlons, a railing around what is shown, lanterns
// on the floor, and the hatch through which one comes up. Metres, y up.
import { mix, noise, random } from '../castle/falcon/field.mjs';
import { block, Part, rod, turned } from '../chapel/shapes.mjs';

const RADIUS = 7.2, RAIL = 3.7, LANTERNS = 8;
const ring = (r, y, count, turn = 0) => Array.from({ length: count }, (_, k) => {
  const angle = 2 * Math.PI * k / count + turn;
  return [r * Math.cos(angle), y, r * Math.sin(angle)];
});

// Rings of slabs, with joints between them over a bed of mortar.
function make_floor(part) {
  const draw = random(11), JOINT = 0.006, WIDE = 0.6, down = [0, -1, 0];
  const place = (r, angle, y = 0) => [r * Math.cos(angle), y, r * Math.sin(angle)];
  const bed = () => [0.16, 0.155, 0.145], circle = (r) => ring(r, -0.012, 48);
  const [inner, outer] = [circle(WIDE), circle(RADIUS + 0.3)];
  for (let k = 0; k < 48; k++)
    part.face([inner[k], inner[(k + 1) % 48], outer[(k + 1) % 48], outer[k]], down, bed);
  const slab = (corners, tone) => part.face(corners, [corners[0][0], -1, corners[0][2]],
      (p) => [0.30, 0.29, 0.27].map((c) => c * mix(0.72, 1.05, tone) *
        (1 + 0.14 * noise(...p.map((one) => 3 * one)))));
  slab(ring(WIDE - JOINT, 0, 16), 0.6);
  for (let r = WIDE; r < RADIUS; r += WIDE) {
    const count = Math.round(2 * Math.PI * (r + 0.3) / 0.9), turn = draw();
    for (let k = 0; k < count; k++) {
      const [from, to] = [k, k + 1].map((one) => 2 * Math.PI * (one + turn) / count);
      const y = -0.004 * draw(), corners = [];
      for (const share of [0, 0.5, 1])
        corners.push(place(r, mix(from, to - JOINT / r, share), y));
      for (const share of [1, 0.5, 0])
        corners.push(place(r + WIDE - JOINT, mix(from, to - JOINT / (r + WIDE), share), y));
      slab(corners, draw());
    }
  }
}

function make_parapet(part) {
  const draw = random(12), count = 40;
  for (let k = 0; k < count; k++) {
    const angle = 2 * Math.PI * k / count, way = [Math.cos(angle), 0, Math.sin(angle)];
    const axes = [way, [0, 1, 0], [-way[2], 0, way[0]]], half = Math.PI * RADIUS / count;
    for (let row = 0; row < (k % 2 ? 5 : 3); row++)
      block(part, [way[0] * RADIUS, 0.17 + 0.34 * row, way[2] * RADIUS], axes,
          [0.3, 0.166, half + 0.02], draw, { ground: -1 });
  }
}

// A ring on posts, at a height that one leans on.
function make_railing(part) {
  const iron = () => [0.045, 0.043, 0.042], circle = ring(RAIL, 1.0, 64);
  rod(part, [...circle, circle[0]], 0.022, iron, 8);
  for (const [x, , z] of ring(RAIL, 0, 16)) rod(part, [[x, -0.02, z], [x, 0.5, z], [x, 1, z]], 0.014,
      iron, 6);
}

function make_lanterns(iron, flame) {
  const black = () => [0.04, 0.038, 0.036], light = () => [1, 1, 1];
  for (const [x, , z] of ring(6.35, 0, LANTERNS, 0.2)) {
    turned(iron, [x, 0, z], [[0.11, 0], [0.11, 0.03], [0.02, 0.03]], 8, black);
    turned(iron, [x, 0.3, z], [[0.11, 0], [0.06, 0.07], [0.01, 0.07]], 8, black);
    for (const [dx, , dz] of ring(0.095, 0, 4, 0.4))
      rod(iron, [[x + dx, 0.02, z + dz], [x + dx, 0.16, z + dz], [x + dx, 0.31, z + dz]], 0.006,
          black, 4);
    turned(flame, [x, 0.06, z], [[0.024, 0], [0.036, 0.05], [0.002, 0.15]], 4, light);
  }
}

function make_hatch(part) {
  const draw = random(14), axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let i = 0; i < 5; i++) {
    const first = part.points.length;
    block(part, [-0.4 + 0.2 * i, 0.03, 5.6], axes, [0.097, 0.03, 0.5], draw,
        { wear: 0.006, jitter: 0.002 });
    for (let n = first; n < part.points.length; n++)
      part.colors[n] = [0.20, 0.135, 0.075].map((c) => c * (1 + 0.25 *
        noise(20 * part.points[n][0], 4, 3 * part.points[n][2])));
  }
}

export function make_terrace() {
  const floor = new Part('Floor', 'stone'), parapet = new Part('Parapet', 'stone');
  const railing = new Part('Railing', 'iron'), lanterns = new Part('Lanterns', 'iron');
  const flames = new Part('Flames', 'flame'), hatch = new Part('Hatch', 'oak');
  make_floor(floor);
  make_parapet(parapet);
  make_railing(railing);
  make_lanterns(lanterns, flames);
  make_hatch(hatch);
  const parts = [floor, parapet, railing, lanterns, flames, hatch];
  for (const part of parts) part.uv = [];
  const matt = (roughnessFactor, metallicFactor = 0) => ({ roughnessFactor, metallicFactor });
  return { parts, materials: [
    { name: 'stone', pbrMetallicRoughness: matt(0.9) },
    { name: 'iron', pbrMetallicRoughness: matt(0.5, 0.6) },
    { name: 'oak', pbrMetallicRoughness: matt(0.7) },
    { name: 'flame', pbrMetallicRoughness: { ...matt(1), baseColorFactor: [0, 0, 0, 1] },
      emissiveFactor: [1, 0.62, 0.27],
      extensions: { KHR_materials_emissive_strength: { emissiveStrength: 14 } } },
  ] };
}
