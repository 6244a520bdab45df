// SPDX-License-Identifier: Apache-2.0
// Shapes of the gem case and of the prism's mount, added to parts ({points, normals, triangles}).
import { add, cross, dot, subtract, unit } from '../falcon/field.mjs';

// Adds flat facets, corners counter-clockwise as seen from outside.
export function add_facets(part, facets) {
  for (const facet of facets) {
    const first = part.points.length;
    let normal = [0, 0, 0];
    for (let i = 2; i < facet.length; i++)
      normal = add(normal, cross(subtract(facet[i - 1], facet[0]), subtract(facet[i], facet[0])));
    for (const corner of facet) {
      part.points.push(corner);
      part.normals.push(unit(normal));
    }
    for (let i = 2; i < facet.length; i++) part.triangles.push([first, first + i - 1, first + i]);
  }
}

// Adds a body turned about the vertical through (x, z): `profile` has [radius, height] from below.
export function add_lathe(part, [x, z], profile, count = 40) {
  for (let i = 1; i < profile.length; i++) {
    const [[r0, y0], [r1, y1]] = [profile[i - 1], profile[i]];
    const slope = unit([y1 - y0, r0 - r1, 0]), first = part.points.length;
    for (let k = 0; k <= count; k++) {
      const a = 2 * Math.PI * k / count, [c, s] = [Math.cos(a), Math.sin(a)];
      for (const [r, y] of [[r0, y0], [r1, y1]]) {
        part.points.push([x + r * c, y, z + r * s]);
        part.normals.push([slope[0] * c, slope[1], slope[0] * s]);
      }
      if (k === count) break;
      const at = first + 2 * k;
      if (r0 > 0) part.triangles.push([at, at + 1, at + 2]);
      if (r1 > 0) part.triangles.push([at + 1, at + 3, at + 2]);
    }
  }
}

// Adds a tube of `radius` along a path; a closed one returns to its begin.
export function add_tube(part, path, radius, closed = false, count = 10) {
  const size = path.length, rings = closed ? size + 1 : size;
  const first = part.points.length;
  let side;
  for (let i = 0; i < rings; i++) {
    const at = path[i % size];
    const next = closed || i + 1 < size ? path[(i + 1) % size] : at;
    const last = closed || i > 0 ? path[(i + size - 1) % size] : at;
    const along = unit(subtract(next, last));
    if (!side) side = Math.abs(along[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0];
    side = unit(add(side, along, -dot(side, along)));
    const other = cross(along, side);
    for (let k = 0; k <= count; k++) {
      const a = 2 * Math.PI * k / count;
      const out = add(side.map((c) => c * Math.cos(a)), other, Math.sin(a));
      part.points.push(add(at, out, radius));
      part.normals.push(out);
      if (i > 0 && k > 0) {
        const d = first + i * (count + 1) + k, [c, b, e] = [d - 1, d - count - 1, d - count - 2];
        part.triangles.push([e, b, c], [b, d, c]);
      }
    }
  }
}

// Adds a moulding around a rectangle of half sizes `w` and `h` in the plane z = 0, its front to +z:
// `profile` has [outwards, z] from the picture's edge on.
export function add_frame(part, [w, h], profile) {
  const corner = ([out, z], i) => [(w + out) * [-1, 1, 1, -1][i], (h + out) * [-1, -1, 1, 1][i], z];
  for (let side = 0; side < 4; side++)
    for (let i = 1; i < profile.length; i++) {
      const next = (side + 1) % 4;
      add_facets(part, [[corner(profile[i], side), corner(profile[i], next),
        corner(profile[i - 1], next), corner(profile[i - 1], side)]]);
    }
}

// Turns and moves what was added to a part since it had `from` points: `axes` are where x, y and z
// go.
export function place(part, from, axes, at) {
  const turn = (p) => [0, 1, 2].map((k) =>
    axes[0][k] * p[0] + axes[1][k] * p[1] + axes[2][k] * p[2]);
  for (let i = from; i < part.points.length; i++) {
    part.points[i] = add(turn(part.points[i]), at);
    part.normals[i] = turn(part.normals[i]);
  }
}
