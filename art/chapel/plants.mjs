// SPDX-License-Identifier: Apache-2.0
// The ground with its grass, and ivy on the walls.
import { add, clamp, mix, noise, random, smoothstep, unit, cross } from '../castle/falcon/field.mjs';
import { floor_height, has_slab, is_inside, walls } from './chapel.mjs';
import { sheet } from './shapes.mjs';

export const PATCH = [16, 21];  // half the sides of the ground that is scanned

// The meadow's height around the ruin, as the scene around the scan has it, too.
export const meadow = (x, z) => -0.12 + 0.22 * noise(x / 9, z / 9, 4) +
  0.06 * noise(x / 2.3, z / 2.3, 5);

// The ground in and around the ruin: rubble has raised it at the walls.
export function ground(x, z) {
  const wall = Math.max(Math.abs(x) - 5, z - 9, -Math.min(z + 12.8, 9));
  const inside = is_inside(x, z, 0.3) ? 1 : 0;
  const outer = meadow(x, z) + 0.34 * smoothstep(3.2, 0, wall) * (0.7 + 0.5 * noise(x, z, 6));
  const inner = floor_height(x, z) - 0.055 + 0.045 * noise(1.4 * x, 1.4 * z, 7);
  const edge = Math.max(Math.abs(x) / PATCH[0], Math.abs(z) / PATCH[1]);
  const path = smoothstep(1.5, 0.6, Math.abs(x)) * smoothstep(7.5, 8.6, z) *
    smoothstep(12.5, 9, z);
  const high = mix(inside ? inner : outer, -0.02, inside ? 0 : path);
  // Its irregular border sinks below the meadow around it.
  const sink = smoothstep(0.78, 0.97, edge + 0.07 * noise(x / 2, z / 2, 8));
  return edge > 0.999 ? -1 : mix(high, -0.75, sink);
}

const EARTH = [0.115, 0.085, 0.055], GRASS = [0.105, 0.155, 0.035], DRY = [0.27, 0.235, 0.095];
const MOSS = [0.085, 0.125, 0.025], LEAVES = [[0.035, 0.075, 0.018], [0.055, 0.105, 0.02],
  [0.075, 0.12, 0.03], [0.12, 0.10, 0.03]];
const over = (a, b, t) => a.map((c, i) => mix(c, b[i], t));

function soil([x, , z]) {
  let c = over(GRASS, DRY, smoothstep(0, 0.7, noise(x / 1.7, z / 1.7, 14)));
  const bare = is_inside(x, z, 0.2) ? 0.55 : 0.12;
  c = over(c, EARTH, clamp(bare + 0.6 * noise(x / 0.5, z / 0.5, 15)));
  c = over(c, MOSS, smoothstep(0.2, 0.5, noise(x / 0.35, z / 0.35, 16)));
  return c.map((one) => one * (1 + 0.25 * noise(x / 0.09, z / 0.09, 17)));
}

export function make_ground(part) {
  const n = 128, m = 168;
  sheet(part, n, m, (i, k) => {
    const x = PATCH[0] * (2 * i / n - 1), z = PATCH[1] * (2 * k / m - 1);
    return [x, ground(x, z), z];
  }, [0, 1, 0], soil);
}

// Adds a leaf or a blade: a triangle or a kite in one colour.
function leaf(part, corners, color) {
  const first = part.points.length;
  corners.forEach((p) => {
    part.points.push(p);
    part.colors.push(color);
  });
  for (let i = 2; i < corners.length; i++) part.triangles.push([first, first + i - 1, first + i]);
}

export function make_grass(part) {
  const draw = random(131);
  let tufts = 0;
  for (let tries = 0; tries < 30000 && tufts < 5200; tries++) {
    const x = 14 * (2 * draw() - 1), z = 19 * (2 * draw() - 1), inside = is_inside(x, z, 0.1);
    if (is_inside(x, z, 0.95) && !is_inside(x, z, -0.05)) continue;
    if (inside ? has_slab(x, z) : Math.abs(x) < 0.8 && z > 8 && z < 12) continue;
    const rich = 0.5 + 0.6 * noise(x / 1.3, z / 1.3, 21);
    const wall = Math.max(Math.abs(x) - 5, z - 9, -z - 12.3);
    if (draw() > (inside ? rich : rich * smoothstep(2.2, 0.4, wall))) continue;
    tufts++;
    const y = ground(x, z) - 0.01, tall = (inside ? 0.09 : 0.17) * (0.6 + 0.9 * rich);
    const tone = over(GRASS, DRY, clamp(0.25 + 0.55 * noise(x / 2, z / 2, 22) + 0.5 * draw() - 0.2));
    for (let i = 0; i < 6; i++) {
      const a = 2 * Math.PI * draw(), lean = 0.35 * draw(), high = tall * (0.5 + 0.8 * draw());
      const p = [x + 0.07 * (draw() - 0.5), y, z + 0.07 * (draw() - 0.5)];
      const side = [-Math.sin(a) * 0.005, 0, Math.cos(a) * 0.005];
      const tip = add(p, [Math.cos(a) * lean * high, high, Math.sin(a) * lean * high]);
      leaf(part, [add(p, side, -1), add(p, side), tip], tone.map((c) => c * (0.75 + 0.6 * draw())));
    }
  }
}

// Ivy climbs a wall's face from a place along it; `side` 1: outside.
function climb(part, wall, from, side, reach, count, seed) {
  const draw = random(seed), stems = 7;
  for (let k = 0; k < stems; k++) {
    let s = from + 0.5 * (draw() - 0.5), y = 0.1, turn = 0.5 * Math.PI + (draw() - 0.5);
    const own = reach * (0.45 + 0.7 * draw());
    const steps = Math.round(own / 0.03);
    for (let i = 0; i < steps; i++) {
      turn += 0.5 * (draw() - 0.5) + 0.06 * (Math.PI / 2 - turn);
      s += 0.03 * Math.cos(turn);
      y += 0.03 * Math.sin(turn);
      if (s < 0.1 || s > wall.length - 0.1 || y > wall.top(s) + 0.2) break;
      if (wall.openings.some((o) => Math.abs(s - o.centre) < (o.width ?? 2) / 2 + 0.05 &&
        y > o.sill && y < o.spring + (o.width ?? 1))) continue;
      const leaves = count / stems / steps * (1.5 - i / steps);
      for (let n = 0; n < Math.floor(leaves + draw()); n++) {
        const { p, n: out } = wall.at(s), way = [side * out[0], 0, side * out[1]];
        const right = [out[1], 0, -out[0]], spread = 0.16 + 0.3 * (1 - i / steps);
        const off = wall.thick / 2 + 0.03 + 0.10 * draw();
        const at = add([p[0] + off * way[0], y + spread * (draw() - 0.5), p[1] + off * way[2]],
            right, 2 * spread * (draw() - 0.5));
        const size = 0.028 + 0.03 * draw(), dip = [0, -1, 0];
        const face = unit(add(add(way, dip, -0.35 * draw()), right, draw() - 0.5));
        const down = unit(add(add(dip, right, draw() - 0.5), face, -dot_of(dip, face)));
        const across = cross(face, down);
        leaf(part, [add(at, down, size), add(add(at, down, -0.2 * size), across, 0.85 * size),
          add(add(at, down, -0.75 * size), face, -0.2 * size),
          add(add(at, down, -0.2 * size), across, -0.85 * size)],
        LEAVES[Math.floor(3.3 * draw())].map((c) => c * (0.7 + 0.7 * draw())));
      }
    }
  }
}
const dot_of = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export function make_ivy(part) {
  climb(part, walls.north, 6.3, -1, 5.2, 2600, 201);
  climb(part, walls.north, 15.4, -1, 4.4, 1500, 202);
  climb(part, walls.north, 11, 1, 5.5, 1300, 203);
  climb(part, walls.chancel, 7.2, 1, 6.3, 2200, 204);
  climb(part, walls.west, 1.2, 1, 6.0, 2200, 205);
  climb(part, walls.west, 7.3, -1, 3.9, 900, 206);
  climb(part, walls.apse, 9.7, -1, 3.2, 1000, 207);
  climb(part, walls.south, 11.6, 1, 4.4, 900, 208);
  climb(part, walls.south, 3.0, -1, 3.4, 700, 209);
}
