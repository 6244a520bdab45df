// SPDX-License-Identifier: Apache-2.0
// The water of a round well: the wave equation u'' = c^2 laplace(u) - k u' on a square grid, by the
// leapfrog scheme (stable while c dt / dx <= 1 / sqrt 2), with steps of a fixed length, so that any
// number of pictures a second shows the same waves. At the rim no water flows, so waves come back.
// Lengths are radii of the well, times seconds.

export const cells = 128;  // along a side of the grid
const speed = 0.9;         // c: radii a second
const step = 1 / 120;      // seconds
const most_behind = 0.25;  // seconds that are made up for; a page that slept makes up no more
const quiet = 2e-5;        // heights below which the water rests
const dx = 2 / cells;
export const courant = speed * step / dx;

// damping: k, a second.
export function make_water(damping = 0.55) {
  const side = cells + 2;  // a cell of border, which is always outside
  const before = new Float32Array(side * side), now = new Float32Array(side * side);
  const next = new Float32Array(side * side), shown = new Float32Array(4 * cells * cells);
  const inside = new Uint8Array(side * side);
  const rows = [];  // first and last cell inside, a row each
  for (let j = 1; j <= cells; j++) {
    const y = (j - 0.5) * dx - 1;
    let first = side, last = -1;
    for (let i = 1; i <= cells; i++) {
      const x = (i - 0.5) * dx - 1;
      if (x * x + y * y >= 1) continue;
      inside[j * side + i] = 1;
      first = Math.min(first, i);
      last = i;
    }
    if (last >= 0) rows.push({ j, first, last, from: last + 1, to: 0 });
  }
  // Cells whose four neighbours are all inside, a row each, need not look.
  for (const row of rows) {
    const near = (i) => [-1, 1, -side, side].every((to) => inside[row.j * side + i + to]);
    for (let i = row.first; i <= row.last; i++)
      if (near(i)) { row.from = Math.min(row.from, i); row.to = i; }
  }
  const count = inside.reduce((sum, value) => sum + value, 0);
  let behind = 0, resting = true, buffers = [before, now, next];

  // Goes a step on. Cells beyond the rim are as high as the cell at the rim.
  function advance() {
    const [old, current, out] = buffers;
    const loss = 0.5 * damping * step, keep = 1 / (1 + loss);
    const drag = (1 - loss) * keep, pull = courant * courant * keep;
    let highest = 0;
    const beside = (k, to, u) => (inside[k + to] ? current[k + to] - u : 0);
    for (const { j, first, last, from, to } of rows) {
      const row = j * side;
      for (let k = row + first; k <= row + last; k++) {
        const u = current[k], v = u - old[k];
        const bent = k >= row + from && k <= row + to
          ? (current[k - 1] - u + (current[k + 1] - u))
            + (current[k - side] - u + (current[k + side] - u))
          : (beside(k, -1, u) + beside(k, 1, u)) + (beside(k, -side, u) + beside(k, side, u));
        out[k] = u + drag * v + pull * bent;
        const size = (u < 0 ? -u : u) + 4 * (v < 0 ? -v : v);
        if (size > highest) highest = size;
      }
    }
    buffers = [current, out, old];
    resting = highest < quiet;
    if (resting) for (const buffer of buffers) buffer.fill(0);
  }

  return {
    // Presses the water down by `depth` around (x, y), both -1..1, or lifts it where depth is
    // negative; water is neither made nor lost. A place outside the well does nothing.
    press(x, y, depth = 0.03, radius = 0.09) {
      if (!(Math.hypot(x, y) < 1) || !Number.isFinite(depth)) return false;
      const [old, current] = buffers, reach = Math.max(radius, 4 * dx);
      let sum = 0;
      const touched = [];
      for (const { j, first, last } of rows)
        for (let i = first; i <= last; i++) {
          const r = Math.hypot((i - 0.5) * dx - 1 - x, (j - 0.5) * dx - 1 - y) / reach;
          if (r >= 1) continue;
          const weight = (0.5 + 0.5 * Math.cos(Math.PI * r)) ** 2;
          touched.push([j * side + i, weight]);
          sum += weight;
        }
      for (const [k, weight] of touched) { current[k] -= depth * weight; old[k] -= depth * weight; }
      const rise = depth * sum / count;
      for (const { j, first, last } of rows)
        for (let k = j * side + first; k <= j * side + last; k++) {
          current[k] += rise;
          old[k] += rise;
        }
      resting = false;
      return true;
    },
    // Goes on by that many seconds; whole steps are made, the rest waits.
    advance(seconds) {
      behind += Math.min(Math.max(seconds, 0) || 0, most_behind);
      while (behind >= step) {
        behind -= step;
        if (!resting) advance();
      }
    },
    // The water at this moment, between two steps: for each of cells x cells places, row by row,
    // its height, its slopes along x and y, and its curvature (laplace(u)); 0 outside.
    surface() {
      const [old, current] = buffers, t = behind / step;
      const at = (k) => old[k] + t * (current[k] - old[k]);
      for (const { j, first, last } of rows)
        for (let i = first; i <= last; i++) {
          const k = j * side + i, u = at(k), o = 4 * ((j - 1) * cells + i - 1);
          const left = inside[k - 1] ? at(k - 1) : u, right = inside[k + 1] ? at(k + 1) : u;
          const above = inside[k - side] ? at(k - side) : u;
          const below = inside[k + side] ? at(k + side) : u;
          shown[o] = u;
          shown[o + 1] = (right - left) / (2 * dx);
          shown[o + 2] = (below - above) / (2 * dx);
          shown[o + 3] = (left + right + above + below - 4 * u) / (dx * dx);
        }
      return shown;
    },
    at_rest: () => resting,
    // The scheme's own energy, which without damping is kept and with it never grows (the product
    // of the slopes of two steps, as of leapfrog: Cohen 2002, section 3.2).
    energy() {
      const [old, current] = buffers;
      let sum = 0;
      for (const { j, first, last } of rows)
        for (let k = j * side + first; k <= j * side + last; k++) {
          const v = (current[k] - old[k]) / step;
          sum += v * v;
          for (const other of [k + 1, k + side])
            if (inside[other])
              sum += (speed / dx) ** 2 * (current[other] - current[k]) * (old[other] - old[k]);
        }
      return 0.5 * sum * dx * dx;
    },
    volume() {
      const [, current] = buffers;
      return current.reduce((sum, u) => sum + u, 0) * dx * dx;
    },
  };
}
