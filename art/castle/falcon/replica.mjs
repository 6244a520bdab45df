// SPDX-License-Identifier: Apache-2.0
// A replica of the mummy with three known faults. Millimetres.
import { BEAK, outside, settle } from './outside.mjs';
import { add, dot, smoothstep, subtract, unit } from './field.mjs';

const BEND = BEAK[2].slice(0, 3), TIP = settle(add(BEAK[5].slice(0, 3), [0, -2, 0]));
const BILL = unit(subtract(TIP, BEND)), BILL_LENGTH = dot(BILL, subtract(TIP, BEND));
const BACK = settle([0, 180, -50]);
const SHORT = 3, DENT = 2, DENT_RADIUS = 16, THICK = 1, PAD = 15;

// Where a point of the true face lies in the replica.
export function displace(p, normal) {
  let moved = p;
  const along = dot(BILL, subtract(p, BEND));
  if (along > 0 && p[2] > 45 && p[1] > 315)
    moved = add(moved, BILL, -SHORT * Math.min(1, along / BILL_LENGTH));
  const far = Math.hypot(...subtract(p, BACK));
  if (far < DENT_RADIUS && p[2] < 0)
    moved = add(moved, [0, 0, 1], DENT * (1 - smoothstep(0, DENT_RADIUS, far)));
  if (p[1] < PAD && normal[1] > -0.5)
    moved = add(moved, unit([normal[0], 0, normal[2]]),
        THICK * smoothstep(0, 0.2, Math.hypot(normal[0], normal[2]))
            * smoothstep(PAD, PAD - 3, p[1]));
  else if (p[1] < PAD)
    moved = add(moved, unit([p[0], 0, p[2]]), THICK * smoothstep(30, 38, Math.hypot(p[0], p[2])));
  return moved;
}

const round = (v) => v.map((c) => +(c / 1000).toFixed(6));

// What is wrong with it. Places are in metres in the mesh's frame.
export function make_truth({ points }, moved) {
  const deepest = moved.map((p) => outside(...p));
  const measured = (choose) => {
    let far = 0, count = 0;
    points.forEach((p, i) => {
      if (!choose(p) || Math.hypot(...subtract(p, moved[i])) < 1e-9) return;
      count++;
      if (Math.abs(deepest[i]) > Math.abs(far)) far = deepest[i];
    });
    return { vertices: count, most_mm: +far.toFixed(2) };
  };
  const beak = (p) => p[2] > 45 && p[1] > 315, base = (p) => p[1] < PAD;
  const rest = (p) => !beak(p) && !base(p) && Math.hypot(...subtract(p, BACK)) >= DENT_RADIUS;
  return {
    about: 'The faults of replica.glb against falcon.nrrd and falcon.glb, all in one frame.',
    units: 'places in metres, x left, y up, z front; sizes in millimetres',
    sign: 'negative: the replica lies inside the true face',
    outer_face_hounsfield: -650,
    faults: [
      { id: 'beak', kind: 'short', size_mm: -SHORT, at: round(TIP), direction: round(BILL.map((c) =>
        1000 * c)), from_original_mm: SHORT, to_original: measured(beak) },
      { id: 'dent', kind: 'dent', size_mm: -DENT, at: round(BACK), radius_m: DENT_RADIUS / 1000,
        direction: [0, 0, 1], to_original: measured((p) => !base(p) && !beak(p)) },
      { id: 'base', kind: 'thick', size_mm: THICK, at: round(settle([45, 7, 0])),
        below_m: (PAD - 3) / 1000, to_original: measured(base) },
    ],
    elsewhere_mm: +points.reduce((most, p, i) =>
      Math.max(most, rest(p) ? Math.abs(deepest[i]) : 0), 0).toFixed(3),
  };
}
