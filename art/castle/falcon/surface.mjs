// SPDX-License-Identifier: Apache-2.0
// A closed mesh of the outer face by surface nets (Gibson, Constrained Elastic Surface Nets, 1998),
// its vertices then moved onto the face.
import { gradient, outside, settle } from './outside.mjs';
import { unit } from './field.mjs';

const LOW = [-72, -4, -60], HIGH = [72, 424, 76];

// Returns points and normals, and triangles that are counter-clockwise from outside.
export function make_surface(cell) {
  const count = LOW.map((low, k) => Math.ceil((HIGH[k] - low) / cell) + 1);
  const [nx, ny, nz] = count;
  const values = new Float32Array(nx * ny * nz);
  const index = (i, j, k) => (k * ny + j) * nx + i;
  const place = (i, j, k) => [LOW[0] + i * cell, LOW[1] + j * cell, LOW[2] + k * cell];
  for (let k = 0; k < nz; k++)
    for (let j = 0; j < ny; j++)
      for (let i = 0; i < nx; i++) values[index(i, j, k)] = outside(...place(i, j, k));

  const points = [], vertex = new Int32Array(nx * ny * nz).fill(-1);
  for (let k = 0; k + 1 < nz; k++)
    for (let j = 0; j + 1 < ny; j++)
      for (let i = 0; i + 1 < nx; i++) {
        const sum = [0, 0, 0];
        let crossings = 0;
        for (let edge = 0; edge < 12; edge++) {
          const axis = edge >> 2, a = [0, 0, 0];
          a[(axis + 1) % 3] = edge & 1;
          a[(axis + 2) % 3] = (edge >> 1) & 1;
          const b = [...a];
          b[axis] = 1;
          const one = values[index(i + a[0], j + a[1], k + a[2])];
          const two = values[index(i + b[0], j + b[1], k + b[2])];
          if (one < 0 === two < 0) continue;
          a[axis] = one / (one - two);
          for (let n = 0; n < 3; n++) sum[n] += a[n];
          crossings++;
        }
        if (!crossings) continue;
        vertex[index(i, j, k)] = points.length;
        points.push(settle(place(...[i, j, k].map((c, n) => c + sum[n] / crossings))));
      }

  const triangles = [];
  const step = [1, nx, nx * ny];
  for (let k = 1; k + 1 < nz; k++)
    for (let j = 1; j + 1 < ny; j++)
      for (let i = 1; i + 1 < nx; i++) {
        const at = index(i, j, k);
        for (let axis = 0; axis < 3; axis++) {
          const in_here = values[at] < 0;
          if (in_here === values[at + step[axis]] < 0) continue;
          const u = step[(axis + 1) % 3], v = step[(axis + 2) % 3];
          const quad = [at - u - v, at - v, at, at - u].map((c) => vertex[c]);
          if (!in_here) quad.reverse();
          const [a, b, c, d] = quad;
          const long = (p, q) => points[p].reduce((s, x, n) => s + (x - points[q][n]) ** 2, 0);
          if (long(a, c) <= long(b, d)) triangles.push([a, b, c], [a, c, d]);
          else triangles.push([a, b, d], [b, c, d]);
        }
      }
  return { points, normals: points.map((p) => unit(gradient(...p))), triangles };
}
