// SPDX-License-Identifier: Apache-2.0
// Cameras as the server has them (server/world/view.h) and how places of one view are found in
// another (server/picture/warp_source.h: Mapping).
export const block = 16;  // pixels a side of what bounds of disparities are kept of
export const least_depth = 1e-6;

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0]];
const add = (a, b, share = 1) => a.map((v, i) => v + share * b[i]);

// pose: {position, yaw, pitch, roll, lens}, angles in radians, of a picture of that size. lens:
// half of its height and where its middle lies, to the right and up, at a depth of 1.
export function view_of(pose, width, height) {
  const { yaw, pitch, roll, lens: [tan_half_fov, ...middle] } = pose;
  const forward = [-Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch),
    -Math.cos(yaw) * Math.cos(pitch)];
  const level = [Math.cos(yaw), 0, -Math.sin(yaw)];
  const right = roll === 0 ? level
    : add(level.map((v) => Math.cos(roll) * v), cross(level, forward), Math.sin(roll));
  return { eye: pose.position, right, up: cross(right, forward), forward,
    tan_half_fov, middle, width, height };
}

// What one of them shows at a pixel the other does, too.
export function is_same(a, b) {
  const near = (p, q) => p.every((v, i) => Math.abs(v - q[i]) < 1e-5);
  return a.width === b.width && a.height === b.height && near(a.eye, b.eye)
    && near(a.forward, b.forward) && near(a.right, b.right)
    && near([a.tan_half_fov, ...a.middle], [b.tan_half_fov, ...b.middle]);
}

// A mapping leads from a pixel (x, y) and its disparity w in one view to another: one + x * across
// + y * down + w * baseline is the place there times its depth over the depth here, and that ratio.
export function make_mapping(from, to) {
  const scale = 2 * from.tan_half_fov / from.height, focal = 0.5 * to.height / to.tan_half_fov;
  const axis_of = (view) => {
    const own = 0.5 * view.height / view.tan_half_fov;
    return [0.5 * view.width - view.middle[0] * own, 0.5 * view.height + view.middle[1] * own];
  };
  const axis = axis_of(to), own_axis = axis_of(from);
  const seen = (d) => {
    const x = dot(d, to.right), y = dot(d, to.up), z = dot(d, to.forward);
    return [focal * x + axis[0] * z, axis[1] * z - focal * y, z];
  };
  const right = from.right.map((v) => v * scale), down = from.up.map((v) => -v * scale);
  const corner = add(add(from.forward, right, -own_axis[0]), down, -own_axis[1]);
  return { one: seen(corner), across: seen(right), down: seen(down),
    baseline: seen(add(from.eye, to.eye, -1)) };
}

// Carries the bounds of the keyframe's blocks forward to those of a picture of `view`: `out` gets
// the farthest and the nearest disparity of each block, row after row.
export function carry_bounds(keyframe, view, back, out) {
  const columns = Math.ceil(view.width / block), rows = Math.ceil(view.height / block);
  const { one, across, down, baseline } = back, from = keyframe.view;
  const from_columns = Math.ceil(from.width / block), from_rows = Math.ceil(from.height / block);
  for (let i = 0; i < columns * rows; i++) { out[2 * i] = Infinity; out[2 * i + 1] = -1; }
  for (let by = 0; by < from_rows; by++)
    for (let bx = 0; bx < from_columns; bx++) {
      const i = 2 * (by * from_columns + bx);
      if (keyframe.blocks[i] > keyframe.blocks[i + 1]) continue;  // nothing is there
      let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity, low = Infinity, high = -1;
      for (let corner = 0; corner < 8; corner++) {
        const s = keyframe.blocks[i + (corner >> 2)] * keyframe.unit;
        const x = (bx + (corner & 1)) * block, y = (by + (corner >> 1 & 1)) * block;
        const z = one[2] + x * across[2] + y * down[2] + s * baseline[2];
        if (!(z > least_depth)) continue;
        const px = (one[0] + x * across[0] + y * down[0] + s * baseline[0]) / (z * block);
        const py = (one[1] + x * across[1] + y * down[1] + s * baseline[1]) / (z * block);
        x0 = Math.min(x0, px); x1 = Math.max(x1, px);
        y0 = Math.min(y0, py); y1 = Math.max(y1, py);
        low = Math.min(low, s / z); high = Math.max(high, s / z);
      }
      if (!(x1 >= 0 && y1 >= 0 && x0 < columns && y0 < rows)) continue;
      const last_x = Math.min(Math.floor(x1), columns - 1),
          last_y = Math.min(Math.floor(y1), rows - 1);
      for (let cy = Math.max(Math.floor(y0), 0); cy <= last_y; cy++)
        for (let cx = Math.max(Math.floor(x0), 0); cx <= last_x; cx++) {
          const c = 2 * (cy * columns + cx);
          if (low < out[c]) out[c] = low;
          if (high > out[c + 1]) out[c + 1] = high;
        }
    }
  borrow_bounds(out, columns, rows);
}

// Blocks that nothing was carried to get the bounds of those around, or lie at infinity.
function borrow_bounds(out, columns, rows) {
  const bare = [];
  for (let i = 0; i < columns * rows; i++) if (out[2 * i + 1] < 0) bare.push(i);
  const found = bare.map((i) => {
    const bx = i % columns, by = Math.floor(i / columns);
    let low = Infinity, high = -1;
    for (const reach of [1, 4]) {
      for (let y = Math.max(by - reach, 0); y <= Math.min(by + reach, rows - 1); y++)
        for (let x = Math.max(bx - reach, 0); x <= Math.min(bx + reach, columns - 1); x++) {
          low = Math.min(low, out[2 * (y * columns + x)]);
          high = Math.max(high, out[2 * (y * columns + x) + 1]);
        }
      if (high >= 0) return [low, high];
    }
    return [0, 0];
  });
  bare.forEach((i, n) => { [out[2 * i], out[2 * i + 1]] = found[n]; });
}
