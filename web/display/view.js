// SPDX-License-Identifier: Apache-2.0
// Cameras as the server has them (server/world/view.h) and how places of one view are found in
// another (server/picture/warp_source.h: Mapping).
export const block = 8;  // pixels a side of what bounds of disparities are kept of
export const least_depth = 1e-6;
const most_blocks = 24;     // written per block, on average, when bounds are carried forward
const larger_pixel = 1.1;   // pixels that are as many times as large count as larger

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

// Both show the same at every pixel.
export function is_same(a, b) {
  const near = (p, q) => p.every((v, i) => Math.abs(v - q[i]) < 1e-5);
  return a.width === b.width && a.height === b.height && near(a.eye, b.eye)
    && near(a.forward, b.forward) && near(a.right, b.right)
    && near([a.tan_half_fov, ...a.middle], [b.tan_half_fov, ...b.middle]);
}

export const focal_of = (view) => 0.5 * view.height / view.tan_half_fov;  // pixels
// Returns where the viewing axis meets the picture, pixels.
export const axis_of = (view) => [0.5 * view.width - view.middle[0] * focal_of(view),
  0.5 * view.height + view.middle[1] * focal_of(view)];

// A mapping leads from a pixel (x, y) and its disparity w in one view to another: one + x * across
// + y * down + w * baseline is the place there times its depth over the depth here, and that ratio.
export function make_mapping(from, to) {
  const scale = 2 * from.tan_half_fov / from.height, focal = focal_of(to);
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

// Says whether the pixels of a keyframe of view `from` are larger than those of the picture.
export const is_coarse = (from, view) =>
  from.tan_half_fov * view.height > larger_pixel * view.tan_half_fov * from.height;

// Carries the bounds of the keyframe's blocks forward to those of a picture of `view`: `out` gets
// the farthest and the nearest disparity of each block, row after row. False: they would move too
// far for that.
export function carry_bounds(keyframe, view, back, out) {
  const columns = Math.ceil(view.width / block), rows = Math.ceil(view.height / block);
  const from = keyframe.view;
  const [px, py, pz] = [0, 1, 2].map((i) => [back.one, back.across, back.down, back.baseline]
      .map((v) => v[i] / (i < 2 ? block : 1)));
  const from_columns = Math.ceil(from.width / block), from_rows = Math.ceil(from.height / block);
  for (let i = 0; i < columns * rows; i++) { out[2 * i] = Infinity; out[2 * i + 1] = -1; }
  let left = most_blocks * columns * rows;
  for (let by = 0; by < from_rows; by++)
    for (let bx = 0; bx < from_columns; bx++) {
      const i = 2 * (by * from_columns + bx);
      if (keyframe.blocks[i] > keyframe.blocks[i + 1]) continue;  // nothing is there
      const levels = keyframe.blocks[i] < keyframe.blocks[i + 1] ? 2 : 1;
      let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity, low = Infinity, high = -1;
      for (let level = 0; level < levels; level++) {
        const s = keyframe.blocks[i + level] * keyframe.unit;
        for (let corner = 0; corner < 4; corner++) {
          const x = (bx + (corner & 1)) * block, y = (by + (corner >> 1)) * block;
          const z = pz[0] + x * pz[1] + y * pz[2] + s * pz[3];
          if (!(z > least_depth)) continue;
          const inverse = 1 / z, w = s * inverse;
          const cx = (px[0] + x * px[1] + y * px[2] + s * px[3]) * inverse;
          const cy = (py[0] + x * py[1] + y * py[2] + s * py[3]) * inverse;
          if (cx < x0) x0 = cx;
          if (cx > x1) x1 = cx;
          if (cy < y0) y0 = cy;
          if (cy > y1) y1 = cy;
          if (w < low) low = w;
          if (w > high) high = w;
        }
      }
      if (!(x1 >= 0 && y1 >= 0 && x0 < columns && y0 < rows)) continue;
      const first_x = Math.max(Math.floor(x0), 0), first_y = Math.max(Math.floor(y0), 0);
      const last_x = Math.min(Math.floor(x1), columns - 1);
      const last_y = Math.min(Math.floor(y1), rows - 1);
      left -= (last_x - first_x + 1) * (last_y - first_y + 1);
      if (left < 0) return false;
      for (let cy = first_y; cy <= last_y; cy++)
        for (let cx = first_x; cx <= last_x; cx++) {
          const c = 2 * (cy * columns + cx);
          if (low < out[c]) out[c] = low;
          if (high > out[c + 1]) out[c + 1] = high;
        }
    }
  borrow_bounds(out, columns, rows);
  return true;
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
