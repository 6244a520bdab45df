// SPDX-License-Identifier: Apache-2.0
// A prism of flint glass on the sill of a window of the hall. At half past one, the exhibit's own
// hour, the sun falls through a pane of the lattice onto it, is bent as little as a prism can
// (minimum deviation), and paints its spectrum into a dark box. Metres, in the hall's coordinates.
import { Part, pbr } from '../falcon/vitrine.mjs';
import { add, cross, unit } from '../falcon/field.mjs';
import { dispersion, index_at } from '../spectra/glass.mjs';
import { cut } from './cut.mjs';
import { add_facets, add_lathe, place } from './shapes.mjs';

// The window: its middle along x, the sill's height, the plane of its lattice, and the cells of
// that (art/castle/scripts/hall.py).
const WINDOW = -2, SILL = 1.15, LATTICE = -4.72, CELL = 0.21, SLOPE = 1.45;
// The sun at the exhibit's own hour (art/castle/scripts/lights.py).
const ELEVATION = 40 * Math.PI / 180, AZIMUTH = 28 * Math.PI / 180;
export const SUN = [-Math.sin(AZIMUTH) * Math.cos(ELEVATION), -Math.sin(ELEVATION),
  Math.cos(AZIMUTH) * Math.cos(ELEVATION)];

const GLASS = 'F2', ANGLE = Math.PI / 3, SIDE = 0.036, LENGTH = 0.1, THROW = 2.2, AWAY = 0.24;
const MIDDLE_NM = 560;

// Returns how the middle of the spectrum goes: where the prism's middle is, the level direction of
// the sun, and angles over the horizon of the ray in the glass and behind it.
export function trace_prism() {
  // The middle of a cell: one and a half cells beside the mullion, one above the sill.
  const cell = [WINDOW + 1.5 * CELL, SILL + SLOPE * CELL];
  const back = AWAY / SUN[2];
  const middle = [cell[0] + SUN[0] * back, cell[1] + SUN[1] * back, LATTICE + AWAY];
  const level = unit([SUN[0], 0, SUN[2]]);
  const bend = (nm) => 2 * Math.asin(index_at(GLASS, nm) * Math.sin(ANGLE / 2)) - ANGLE;
  const deviation = bend(MIDDLE_NM), inside = -ELEVATION + deviation / 2;
  return { middle, level, inside, leaves: -ELEVATION + deviation, deviation };
}

// Returns the angle over the horizon at which a wavelength leaves the prism.
export function leaves_at(nm) {
  const { inside, deviation } = trace_prism(), n = index_at(GLASS, nm);
  const enters = (deviation + ANGLE) / 2, first = Math.asin(Math.sin(enters) / n);
  const second = Math.asin(n * Math.sin(ANGLE - first));
  return inside - deviation / 2 + (enters + second - ANGLE);
}

// Returns where the spectrum's middle meets the card, and the box's axes: x away from who
// looks into it, z to the prism, y up.
export function find_card() {
  const { middle, level, leaves } = trace_prism();
  const at = add(add(middle, level, THROW * Math.cos(leaves)), [0, 1, 0], THROW * Math.sin(leaves));
  const [c, s] = [Math.cos(leaves), Math.sin(leaves)];
  const z = [-level[0] * c, -s, -level[2] * c], y = [-level[0] * s, c, -level[2] * s];
  return { at, axes: [cross(y, z), y, z] };
}

// The prism hangs with its edge down between two plates of brass on a foot.
function make_prism() {
  const { middle, level, inside } = trace_prism();
  const glass = new Part('Prism', 'flint'), brass = new Part('Prism Mount', 'brass');
  // In the local frame z is the prism's axis, x the ray inside, y from the edge to the base.
  const x = add(level.map((c) => c * Math.cos(inside)), [0, 1, 0], Math.sin(inside));
  const y = add(level.map((c) => c * -Math.sin(inside)), [0, 1, 0], Math.cos(inside));
  const axes = [x, y, cross(x, y)], height = SIDE * Math.cos(ANGLE / 2);
  const half = ANGLE / 2, sides = (grow) => [[[0, 1, 0], height / 3 + grow],
    [[Math.cos(half), -Math.sin(half), 0], height / 3 + grow],
    [[-Math.cos(half), -Math.sin(half), 0], height / 3 + grow]];
  const slab = (low, high) => [[[0, 0, 1], high], [[0, 0, -1], -low]];
  add_facets(glass, cut([...sides(0), ...slab(-LENGTH / 2, LENGTH / 2)]));
  place(glass, 0, axes, middle);
  for (const side of [-1, 1]) {
    const [a, b] = [side * (LENGTH / 2 + 0.0005), side * (LENGTH / 2 + 0.0035)];
    add_facets(brass, cut([...sides(0.003), ...slab(Math.min(a, b), Math.max(a, b))]));
  }
  place(brass, 0, axes, middle);
  // Two arms and a bar below, level along the prism's axis, and the foot.
  const from = brass.points.length, low = -height * 2 / 3 - 0.02;
  for (const side of [-1, 1]) {
    const at = side * (LENGTH / 2 + 0.005);
    brass.box([-0.005, low, at - 0.002], [0.005, 0.004, at + 0.002], 0.0006);
  }
  brass.box([-0.005, low - 0.006, -LENGTH / 2 - 0.007], [0.005, low, LENGTH / 2 + 0.007], 0.001);
  place(brass, from, [level, [0, 1, 0], cross(level, [0, 1, 0])], middle);
  add_lathe(brass, [middle[0], middle[2]], [[0, SILL], [0.034, SILL], [0.034, SILL + 0.005],
    [0.012, SILL + 0.01], [0.006, SILL + 0.016], [0.006, middle[1] + low - 0.003]]);
  return [glass, brass];
}

// A dark box: a snout towards the prism lets little of the sky in, the side to who looks is open,
// and the white card stands aslant within. It is carried by a post.
function make_box() {
  const { at, axes } = find_card(), a = 0.17, high = 0.17, wall = 0.008, snout = 0.36;
  const board = new Part('Spectrum Box', 'black oak'), card = new Part('Spectrum', 'white card');
  const post = new Part('Spectrum Post', 'brass');
  for (const y of [high, -high + wall]) {
    const loop = [[-a, y, -a], [-a, y, a], [a, y, a]];
    add_facets(board, [loop, loop.map(([x, , z]) => [x, y - wall, z]).reverse()]);
  }
  // Edges of floor and roof towards who looks, and the corner of front and side.
  const edge = 0.012;
  board.box([-a - edge, -high, -a], [-a, -high + wall, a], 0.001);
  board.box([-a - edge, high - wall, -a], [-a, high, a], 0.001);
  board.box([-a - edge, -high, -a - edge], [-a, high, -a], 0.001);
  // The front has a slit as wide and high as the fan of light there, and the snout around it.
  const [left, right, low, top] = [-0.06, 0.06, -0.058, 0.118];
  const front = (x0, y0, x1, y1, from, to) => board.box([x0, y0, from], [x1, y1, to], 0.001);
  front(-a - edge, -high, left, high, a - 0.002, a + 0.006);
  front(right, -high, a + 0.004, high, a - 0.002, a + 0.006);
  front(left, -high, right, low, a - 0.002, a + 0.006);
  front(left, top, right, high, a - 0.002, a + 0.006);
  front(left - wall, low - wall, left, top + wall, a, a + snout);
  front(right, low - wall, right + wall, top + wall, a, a + snout);
  front(left, low - wall, right, low, a, a + snout);
  front(left, top, right, top + wall, a, a + snout);
  // The card, and its black back.
  const d = 0.002, corners = (lift) => [[-a, -high + wall, -a], [a, -high + wall, a],
    [a, high - wall, a], [-a, high - wall, -a]].map(([x, y, z]) => [x - lift, y, z + lift]);
  add_facets(card, [corners(d)]);
  add_facets(board, [corners(-wall).reverse()]);
  place(board, 0, axes, at), place(card, 0, axes, at);
  const foot = at[1] - high * axes[1][1];
  add_lathe(post, [at[0], at[2]], [[0, 0], [0.15, 0], [0.15, 0.012], [0.06, 0.035], [0.022, 0.05],
    [0.019, foot - 0.03], [0.06, foot - 0.006], [0.06, foot]]);
  return [board, card, post];
}

export function make_prism_file(brass) {
  return {
    generator: 'art/castle/gems/make_gems.mjs', parts: [...make_prism(), ...make_box()],
    materials: [brass,
      { name: 'black oak', pbrMetallicRoughness: pbr([0.012, 0.010, 0.009], 0.8) },
      { name: 'white card', pbrMetallicRoughness: pbr([0.88, 0.88, 0.87], 0.9), doubleSided: true },
      { name: 'flint', pbrMetallicRoughness: pbr([1, 1, 1], 0), extensions: {
        KHR_materials_transmission: { transmissionFactor: 1 },
        KHR_materials_ior: { ior: round(index_at(GLASS, 587.5618)) },
        KHR_materials_dispersion: { dispersion: round(dispersion(GLASS)) },
        KHR_materials_volume: { thicknessFactor: SIDE } } },
    ],
    ...make_light(),
  };
}

// The light of the painting on the gate's wall; others have theirs in the castle's own scene.
function make_light() {
  // A light shines along -z; this one is turned to +x, then down.
  const name = 'Light Study', down = Math.atan2(1.7, 1.9), turn = -Math.PI / 2;
  const [sd, cd, st, ct] = [Math.sin(-down / 2), Math.cos(down / 2), Math.sin(turn / 2),
    Math.cos(turn / 2)];
  return {
    nodes: [{ name, translation: [6.1, 3.33, 3],
      rotation: [ct * sd, st * cd, -st * sd, ct * cd].map(round),
      extensions: { KHR_lights_punctual: { light: 0 } } }],
    extras: { extensions: { KHR_lights_punctual: { lights: [{ name, type: 'spot',
      color: [1, 0.86, 0.68], intensity: 9,
      spot: { innerConeAngle: 0.13, outerConeAngle: 0.3 } }] } } },
  };
}
const round = (value) => Number(value.toFixed(4));
