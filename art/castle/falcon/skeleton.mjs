// SPDX-License-Identifier: Apache-2.0
// The falcon's bones and feathers in the bundle, as tubes, plates, beads and shells. Millimetres;
// x to the bird's left, y up, z to the front. Lengths are a peregrine's.
import { add, curve, mix, random } from './field.mjs';

const AIR = -900, MARROW = -250;
export const SKULL = [0, 367, -9];
export const NECK = curve([[0, 355, -24], [0, 343, -29], [0, 326, -26], [0, 309, -14],
  [0, 296, -8], [0, 284, -12], [0, 274, -19]], 3);
const BACK = curve([[0, 274, -19], [0, 250, -25], [0, 218, -27]], 4);
export const RUMP = [0, 142, -24];

const tube = (points, wall = 0.7, core = AIR, hounsfield = 1250) =>
  ({ kind: 'tube', points, wall, core, hounsfield });
const solid = (points, hounsfield = 1100) => tube(points, 99, hounsfield, hounsfield);
const plate = (corners, thick = 0.8, hounsfield = 1050) =>
  ({ kind: 'plate', corners, thick, hounsfield });
const shell = (centre, radii, wall, cuts = [], hounsfield = 1150) =>
  ({ kind: 'shell', centre, radii, wall, cuts, hounsfield });
// A bent plate: `at` gives its point for 0 to 1 along and across.
function sheet(at, along, across, thick, hounsfield = 1050) {
  const plates = [];
  for (let i = 0; i < along; i++)
    for (let j = 0; j < across; j++) {
      const corner = (u, v) => at((i + u) / along, (j + v) / across);
      plates.push(plate([corner(0, 0), corner(1, 0), corner(1, 1)], thick, hounsfield),
          plate([corner(0, 0), corner(1, 1), corner(0, 1)], thick, hounsfield));
    }
  return plates;
}
const mirror = (point, side) => [side * point[0], ...point.slice(1)];

// A long bone: thicker at both ends, bent by `bow` in its middle.
function long_bone(from, to, radius, { wall = 1.0, core = AIR, bow = [0, 0, 0], ends = 1.5 } = {}) {
  const line = curve([from, add(from.map((c, i) => (c + to[i]) / 2), bow), to], 5);
  const last = line.length - 1;
  return tube(line.map((p, i) => {
    const t = Math.min(i, last - i) / last;
    return [...p, radius * mix(ends, 1, Math.min(1, t / 0.18))];
  }), wall, core);
}

function head(draw) {
  const [x, y, z] = SKULL, bones = [];
  const orbit = (side) => ({ centre: [side * 18, y - 1, z + 17], radius: 12.5 });
  bones.push(shell([x, y + 1, z], [17.5, 16, 18], 1.4, [orbit(1), orbit(-1)]));
  bones.push(plate([[0, y + 8, z + 10], [0, y - 9, z + 8], [0, y - 1, z + 30]], 0.7));
  bones.push(solid([[0, y + 11, z + 12, 4.5], [0, y + 9, z + 22, 4], [0, y + 4, z + 30, 3.6]]));
  const bill = curve([[0, y + 3, z + 27, 5.6], [0, y + 1, z + 36, 5.4], [0, y - 5, z + 44, 4.2],
    [0, y - 13, z + 49, 2.4], [0, y - 20, z + 49.5, 0.8]], 4);
  bones.push(tube(bill, 1.3, -300, 1150));
  for (const side of [-1, 1]) {
    bones.push(solid([[side * 6, y + 11, z + 24, 1.6], [side * 17, y + 11, z + 15, 1.5],
      [side * 19, y + 6, z + 9, 1.1]]));                                      // the brow
    const ring = Array.from({ length: 25 }, (_, i) => {
      const a = 2 * Math.PI * i / 24;
      return [side * (19 - 1.5 * Math.cos(a)), y - 1 + 7.4 * Math.sin(a), z + 18
          + 7.4 * Math.cos(a), 1.15];
    });
    bones.push(solid(ring, 900));                                             // of the eye
    bones.push(solid([[side * 13, y - 13, z + 8, 1], [side * 12, y - 11, z + 20, 0.9],
      [side * 5, y - 5, z + 33, 1.1]]));                                      // the cheek
    bones.push(solid([[side * 15, y - 8, z + 4, 2.4], [side * 14, y - 15, z + 7, 2]]));
    bones.push(solid([[side * 3, y - 10, z + 8, 1], [side * 3.5, y - 7, z + 30, 1.2]]));
    bones.push(tube(curve([[side * 15, y - 17, z + 6, 2.1], [side * 12, y - 19, z + 20, 2],
      [side * 6.5, y - 17, z + 33, 1.9], [0, y - 16, z + 41, 2.2]], 4), 0.9, -200));  // its jaw
  }
  const hyoid = draw() - 0.5;
  bones.push(solid([[hyoid, y - 16, z + 4, 0.7], [0, y - 17, z + 30, 0.9]], 700));
  return bones;
}

function column() {
  const bones = [];
  const bead = (a, b, radius, spine, wide) => {
    const middle = a.map((c, i) => (c + b[i]) / 2), along = (t) => a.map((c, i) => mix(c, b[i], t));
    bones.push(tube([[...along(0.06), radius], [...middle, radius * 0.78],
      [...along(0.94), radius]], 1.1, -150));
    bones.push(solid([[...middle, 0.9], [...add(middle, spine), 0.7]]));
    for (const side of [-1, 1])
      bones.push(solid([[...middle, 1.1], ...[add(middle, [side * wide, 1.5, -0.5])]
          .map((p) => [...p, 0.9])]));
  };
  for (let i = 0; i + 1 < NECK.length; i++)
    bead(NECK[i], NECK[i + 1], 3.1 + 0.06 * i, [0, 0.8, -3.4], 5.2);
  for (let i = 0; i + 1 < BACK.length; i++) bead(BACK[i], BACK[i + 1], 3.3, [0, 0, -6.5], 7);
  bones.push(plate([[0, 272, -24], [0, 222, -33], [0, 222, -30]], 0.9));
  for (let i = 0; i < 6; i++) {                                               // of the tail
    const y = 166 - 4.2 * i;
    bead([0, y, -27 + 0.3 * i], [0, y - 3.8, -26.8 + 0.3 * i], 2.1, [0, 0, -2.5], 5.5 - 0.4 * i);
  }
  bones.push(plate([[0, 143, -26], [0, 128, -30], [0, 130, -19]], 1.6));
  return bones;
}

function trunk() {
  const bones = [];
  for (const side of [-1, 1]) {
    const m = (...points) => points.map((p) => mirror(p, side));
    bones.push(long_bone(...m([6, 265, 15], [20, 290, -3]), 2.3, { ends: 1.4 }));     // coracoid
    bones.push(plate(m([20, 290, -7], [15, 232, -27], [12.5, 236, -28]), 1.1));
    bones.push(solid(m([20, 291, -6, 2.2], [17, 262, -20, 1.5], [14, 234, -27, 1])));
    bones.push(solid(curve(m([21, 292, -1, 1.6], [17, 281, 15, 1.5], [8, 268, 26, 1.5],
        [0, 263, 29, 1.7]), 4)));                                             // the wishbone
    for (let i = 0; i < 7; i++) {
      const y = 268 - 7.2 * i, wide = 24 + 4 * Math.sin(Math.PI * (i + 0.6) / 7.5);
      bones.push(solid(curve(m([4, y, -23 - 0.5 * i, 1], [wide * 0.7, y - 3, -24, 1.1],
          [wide, y - 9, -9, 1.1], [wide - 1, y - 15, 1, 1]), 4), 1000));
      bones.push(solid(curve(m([wide - 1, y - 15, 1, 1], [wide - 3, y - 11, 9, 0.9],
          [16.5, 258 - 6.6 * i, 14, 0.9]), 3), 900));
      if (i > 0 && i < 6)
        bones.push(solid(m([wide - 0.5, y - 6, -14, 0.9], [wide - 1, y + 2, -18, 0.6]), 900));
    }
    bones.push(...sheet((t, u) => {                                           // the pelvis
      const y = 222 - 74 * t, wide = 5 + 11 * Math.sin(Math.PI * (0.12 + 0.72 * t)) - 3 * t * t;
      return mirror([1.5 + wide * u, y - 4 * u * t, -31 + 3 * t + (5 + 6 * t) * u * u], side);
    }, 7, 3, 0.75));
    bones.push(solid(curve(m([15, 190, -16, 1.6], [16, 168, -13, 1], [13, 146, -15, 0.8]), 4)));
    bones.push(solid(m([14, 193, -17, 3.2], [14.5, 186, -17, 3.2]), 1000));
  }
  // The breastbone, hollow to the inside, and its keel.
  const floor = (t) => 18 + 4 * t;
  bones.push(...sheet((t, u) => {
    const s = 2 * u - 1, wide = 12 + 6.5 * Math.sin(Math.PI * Math.min(1, 0.15 + 0.8 * t));
    return [s * wide, 264 - 62 * t + 5 * s * s * (1 - 2 * t), floor(t) - 6.5 * s * s];
  }, 7, 6, 0.7));
  const keel = (t) => floor(t) + 18 * Math.sin(Math.PI * t ** 0.62) ** 0.9 * (1 - 0.3 * t);
  bones.push(...sheet((t, u) => [0, 264 - 62 * t, mix(floor(t), keel(Math.min(t, 0.999)), u)],
      18, 2, 0.75));
  bones.push(solid(Array.from({ length: 11 }, (_, i) =>
    [0, 264 - 6.2 * i, keel(Math.min(i / 10, 0.999)), 1.15])));
  bones.push(tube([[0, 220, -28, 4], [0, 185, -29, 4.4], [0, 166, -28, 2.8]], 1.1, -350));
  return bones;
}

function wing(side, draw) {
  const jog = () => (draw() - 0.5) * 3;
  const shoulder = mirror([22, 288, -5], side);
  const elbow = mirror([36 + jog(), 207 + jog(), -22], side);
  const wrist = mirror([37, 284 + jog(), 10 + jog()], side);
  const knuckle = mirror([39 + jog(), 228 + jog(), 15], side);
  const out = (x, z) => [side * x, 0, z];
  const bones = [
    long_bone(shoulder, elbow, 3.5, { ends: 1.75, bow: out(3, -3) }),
    long_bone(elbow, wrist, 2.9, { ends: 1.4, bow: out(4, -4) }),
    long_bone(add(elbow, [side * 2, 1, 5]), add(wrist, [side, -1, 3]), 1.9,
        { ends: 1.3, bow: out(2, 3) }),
    long_bone(add(wrist, [0, -5, 2]), knuckle, 2, { ends: 1.5 }),
    long_bone(add(wrist, [side, -12, -2]), add(knuckle, [0, 4, -4]), 1.1, { ends: 1.3 }),
    solid([[...add(wrist, [0, 1, -3]), 2.4], [...add(wrist, [side * 2, -3, 1]), 2.6]]),
    solid([[...add(wrist, [-side, -4, 6]), 1.5], [...add(wrist, [-side * 2, -17, 9]), 0.8]]),
    long_bone(add(knuckle, [0, -1, 0]), add(knuckle, [-side, -18, -2]), 1.7, { ends: 1.3 }),
    solid([[...add(knuckle, [-side, -19.5, -2]), 1.4],
      [...add(knuckle, [-2 * side, -34, -6]), 0.6]]),
  ];
  const quills = [];
  for (let i = 0; i < 10; i++) {
    const t = i / 9, root = add(add(wrist, [side * 1.5, -8, 3]),
        [0.5 * (knuckle[0] - wrist[0]), -70 * t, -7 * t]);
    quills.push({ root,
      tip: mirror([10 + 13 * (1 - t), 62 - 30 * t + 2 * jog(), -19 - 3 * t], side),
      belly: mirror([41 - 4 * t, 150, -10 - 6 * (1 - t)], side), radius: 1.5 });
  }
  for (let i = 0; i < 9; i++) {
    const t = (i + 0.5) / 9;
    const root = elbow.map((c, k) => mix(c, wrist[k], t) + [side * 3, 0, -4][k]);
    quills.push({ root, tip: mirror([17 + 8 * t, 98 + 6 * i + jog(), -31 + 8 * t], side),
      belly: mirror([34 + 4 * t, 165 + 5 * i, -27 + 14 * t], side), radius: 1.15 });
  }
  return { bones, quills };
}

export const RING_AT = { side: 1, t: 0.44 };
const leg_line = (side) => ({
  hip: mirror([14, 189, -15], side), knee: mirror([27, 166, 20], side),
  heel: mirror([19, 98, -6], side), foot: mirror([17, 62, 8], side) });

// The place and the way of the shin that wears the ring.
export function ring_place() {
  const { heel, foot } = leg_line(RING_AT.side);
  return { centre: heel.map((c, i) => mix(c, foot[i], RING_AT.t)),
    along: foot.map((c, i) => c - heel[i]) };
}

function leg(side, draw) {
  const { hip, knee, heel, foot } = leg_line(side);
  const bones = [
    long_bone(hip, knee, 3.1, { ends: 1.5, bow: [0, 0, 2] }),
    long_bone(add(knee, [0, -3, 0]), heel, 3, { ends: 1.5, core: MARROW, bow: [side, 0, 2] }),
    solid([[...add(knee, [side * 4, -5, -2]), 1.2], [...add(knee, [side * 2, -45, -14]), 0.5]]),
    long_bone(add(heel, [0, -3, 1]), foot, 2.7, { ends: 1.6, core: MARROW }),
    solid([[...add(knee, [0, 1, 4]), 1.8], [...add(knee, [0, -3, 5]), 1.5]]),
  ];
  const toe = (start, way, joints, down) => {
    let p = add(foot, start), bend = down;
    for (let i = 0; i < joints; i++) {
      const size = 9.5 - 1.5 * i, next = add(p, [way[0] * size * Math.cos(bend),
        -size * Math.sin(bend), way[1] * size * Math.cos(bend)]);
      bones.push(long_bone(p, next, 1.55 - 0.1 * i, { ends: 1.35, wall: 0.9, core: MARROW }));
      p = add(p, next.map((c, k) => c - p[k]), 1.1);
      bend += 0.32 + 0.12 * draw();
    }
    const claw = [];
    for (let i = 0; i <= 6; i++) {
      claw.push([...p, 1.7 * (1 - i / 6.6)]);
      p = add(p, [way[0] * 2.3 * Math.cos(bend), -2.3 * Math.sin(bend),
        way[1] * 2.3 * Math.cos(bend)]);
      bend += 0.2;
    }
    bones.push(tube(claw, 1, 350, 800));
  };
  toe([side * 4, -2, 1], [side * 0.45, 0.9], 3, 0.95);
  toe([0, -2, 3], [side * 0.05, 1], 3, 1.05);
  toe([-side * 4, -2, 1], [-side * 0.35, 0.93], 3, 1.0);
  toe([-side * 1, -1, -4], [-side * 0.2, -0.95], 2, 0.9);
  return bones;
}

// A mouse, the bird's last meal, curled up in the gizzard.
function meal() {
  const at = [5, 214, 2], bones = [], spine = [];
  bones.push(shell(add(at, [-6, 6, 2]), [3.4, 3, 4.6], 0.8, [], 850));
  bones.push(solid([[...add(at, [-6, 4, 5]), 1.3], [...add(at, [-6, 3, 9]), 0.7]], 850));
  for (let i = 0; i <= 16; i++) {
    const a = 0.5 + 0.25 * i;
    spine.push([...add(at, [6.5 * Math.cos(a), 7.5 * Math.sin(a), 2 * Math.cos(2 * a)]),
      1 - 0.035 * i]);
  }
  for (const [i, p] of spine.entries())
    if (i + 1 < spine.length)
      bones.push(solid([p, p.map((c, k) => mix(c, spine[i + 1][k], 0.55))], 800));
  for (const [a, b] of [[[-2, -3, 4], [6, -6, 5]], [[6, -6, 5], [1, -10, 1]],
    [[-4, 2, -3], [3, -2, -5]]])
    bones.push(solid([[...add(at, a), 0.75], [...add(at, b), 0.7]], 750));
  return bones;
}

// Bones, and quills of wings and tail as {root, belly, tip, radius}.
export function make_skeleton() {
  const draw = random(11);
  const wings = [wing(-1, draw), wing(1, draw)];
  const tail = Array.from({ length: 12 }, (_, i) => {
    const x = (i - 5.5) / 5.5, root = [5 * x, 134, -24];
    return { root, belly: [11 * x, 85, -25 - 2 * (1 - x * x)],
      tip: [15 * x, 22 + 5 * x * x, -24 + 1.2 * (i % 2)], radius: 1.35 };
  });
  return {
    bones: [...head(draw), ...column(), ...trunk(), ...wings.flatMap(({ bones }) => bones),
      ...leg(-1, draw), ...leg(1, draw), ...meal()],
    quills: [...wings.flatMap(({ quills }) => quills), ...tail],
  };
}
