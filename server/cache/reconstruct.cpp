// SPDX-License-Identifier: Apache-2.0
#include "cache/reconstruct.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <vector>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"

namespace wellspring {

SurfaceCounts gather_surface(const PointCache& points, const PointImage& image,
                             SurfaceImage& surface, Frame& frame) {
  constexpr size_t ahead = 24;  // pixels by which point data is fetched early
  std::atomic<int64_t> shown{0}, ages{0}, converged{0};
  parallel_ranges(image.height, 8, [&](int begin, int end) {
    size_t first = size_t(begin) * size_t(image.width), last = size_t(end) * size_t(image.width);
    SurfaceCounts here;
    for (size_t i = first; i < last; i++) {
      if (i + ahead < last && image.point[i + ahead] != no_point) {
        __builtin_prefetch(&points.color[image.point[i + ahead]]);
        __builtin_prefetch(&points.normal[image.point[i + ahead]]);
      }
      uint32_t point = image.point[i];
      if (point == no_point) {
        surface.albedo[i] = surface.rest[i] = 0;
        surface.normal[i] = 0;
        frame.color[i] = vec3(0);
        frame.confidence[i] = 0;
        frame.depth[i] = 0;
        frame.object[i] = 0;
        continue;
      }
      const PointColor& color = points.color[point];
      surface.albedo[i] = color.albedo;
      surface.rest[i] = color.rest;
      surface.normal[i] = points.normal[point];
      frame.color[i] = unpack_rgb9e5(color.smooth);
      frame.confidence[i] = float(points.count[point]);
      frame.depth[i] = image.depth[i];
      frame.object[i] = color.object;
      here.points++;
      here.ages += points.age[point];
      here.converged += points.count[point] >= converged_samples;
    }
    shown += here.points;
    ages += here.ages;
    converged += here.converged;
  });
  return {shown, ages, converged};
}

namespace {

constexpr int run = 64;  // pixels filled together

// Three rows of the picture around the one being filled, padded by an empty pixel in front and a
// run at the end. Pixels without a point have object no_object.
struct Rows {
  std::vector<uint32_t> object, albedo;
  std::vector<float> depth;
  size_t stride = 0;
  size_t start(int y) const { return size_t(y + 1) % 3 * stride + 1; }
};

void load_row(const PointImage& image, const SurfaceImage& surface, const Frame& frame, int y,
              Rows& rows) {
  size_t to = rows.start(y), from = size_t(y) * size_t(image.width);
  bool outside = y < 0 || y >= image.height;
  for (size_t x = 0; x < size_t(image.width); x++) {
    bool there = !outside && image.point[from + x] != no_point;
    rows.object[to + x] = there ? frame.object[from + x] : no_object;
    rows.albedo[to + x] = there ? surface.albedo[from + x] : 0;
    rows.depth[to + x] = there ? frame.depth[from + x] : 0.0f;
  }
}

// What the eight neighbours of each pixel of a run say: sums over those of the object with most
// weight (weighted majority vote: exact where one object has more than half), and which of them is
// nearest.
struct Neighbours {
  alignas(64) uint32_t object[run];
  alignas(64) int32_t votes[run], weight[run], red[run], green[run], blue[run], nearest[run];
  alignas(64) float depth[run];
};

constexpr int around_x[8] = {-1, 1, 0, 0, -1, 1, -1, 1}, around_y[8] = {0, 0, -1, 1, -1, -1, 1, 1};

// Not inlined: only as parameters of a real call do the pointers keep their promise not to overlap.
[[gnu::noinline]] void vote(const uint32_t* __restrict other, int32_t w, Neighbours& __restrict n) {
  for (int i = 0; i < run; i++) {
    int32_t there = -int32_t(other[i] != no_object), same = -int32_t(other[i] == n.object[i]);
    int32_t votes = n.votes[i] + (there & ((same & (2 * w)) - w)), lost = there & (votes >> 31);
    n.object[i] = (n.object[i] & uint32_t(~lost)) | (other[i] & uint32_t(lost));
    n.votes[i] = (votes ^ lost) - lost;
  }
}
[[gnu::noinline]] void add_elected(const uint32_t* __restrict other,
                                   const uint32_t* __restrict albedo, const float* __restrict depth,
                                   int32_t k, int32_t w, Neighbours& __restrict n) {
  float weight = float(w);
  for (int i = 0; i < run; i++) {
    int32_t same = -int32_t(other[i] == n.object[i]) & -int32_t(other[i] != no_object),
            share = same & w;
    int32_t color = int32_t(albedo[i]);
    n.weight[i] += share;
    n.red[i] += share * (color & 2047);
    n.green[i] += share * ((color >> 11) & 2047);
    n.blue[i] += share * ((color >> 22) & 1023);
    n.depth[i] += std::bit_cast<float>(std::bit_cast<int32_t>(weight * depth[i]) & same);
    n.nearest[i] = (n.nearest[i] & ~same) | (k & same);
  }
}

void ask_neighbours(const Rows& rows, int x0, int y, Neighbours& n) {
  std::memset(&n, 0, sizeof n);
  std::fill_n(n.object, run, no_object);
  size_t at[8];
  for (int k = 0; k < 8; k++)
    at[k] = rows.start(y + around_y[k]) + size_t(x0 + 1 + around_x[k]) - 1;
  for (int k = 0; k < 8; k++) vote(rows.object.data() + at[k], k < 4 ? 2 : 1, n);
  // The nearest last, so that it stays.
  for (int k = 7; k >= 0; k--)
    add_elected(rows.object.data() + at[k], rows.albedo.data() + at[k], rows.depth.data() + at[k],
                k, k < 4 ? 2 : 1, n);
}

// A pixel from the cells around it: bilinear among those of the object with most weight.
void fill_from_cells(const PixelRays& rays, const mat3& to_world, const Cells& cells, int x, int y,
                     size_t i, SurfaceImage& surface, Frame& frame) {
  int cx = (x + cell_size / 2) / cell_size - 1, cy = (y + cell_size / 2) / cell_size - 1;
  float fx = (float(x) + 0.5f) / cell_size - 0.5f - float(cx),
        fy = (float(y) + 0.5f) / cell_size - 0.5f - float(cy);
  size_t cell[4];
  float weight[4];
  for (int k = 0; k < 4; k++) {
    int ax = std::clamp(cx + (k & 1), 0, cells.width - 1),
        ay = std::clamp(cy + (k >> 1), 0, cells.height - 1);
    cell[k] = size_t(cells.index(ax, ay));
    weight[k] = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy) + 1e-4f;
  }
  float best = 0;
  uint32_t object = no_object;
  for (int k = 0; k < 4; k++) {
    float support = 0;
    for (int j = 0; j < 4; j++)
      if (cells.object[cell[j]] == cells.object[cell[k]]) support += weight[j];
    if (support > best) best = support, object = cells.object[cell[k]];
  }
  vec3 albedo(0), rest(0), smooth(0), normal(0);
  float inverse_depth = 0, sum = 0;
  vec3 ray(rays.x(float(x) + 0.5f), rays.y(float(y) + 0.5f), 1);
  for (int k = 0; k < 4; k++) {
    if (cells.object[cell[k]] != object) continue;
    for (size_t c = 0; c < 3; c++) {
      albedo[int(c)] += weight[k] * cells.albedo[c][cell[k]];
      rest[int(c)] += weight[k] * cells.rest[c][cell[k]];
      smooth[int(c)] += weight[k] * cells.smooth[c][cell[k]];
      normal[int(c)] += weight[k] * cells.normal[c][cell[k]];
    }
    vec3 plane(cells.plane[0][cell[k]], cells.plane[1][cell[k]], cells.plane[2][cell[k]]);
    float middle = 1 / cells.depth[cell[k]];
    inverse_depth += weight[k] * std::clamp(dot(plane, ray), 0.5f * middle, 2 * middle);
    sum += weight[k];
  }
  float share = 1 / sum;
  surface.albedo[i] = pack_albedo(albedo * share);
  surface.rest[i] = pack_rgb9e5(rest * share);
  surface.normal[i] = pack_normal(to_world * normal);
  frame.color[i] = smooth * share;
  frame.depth[i] = sum / inverse_depth;
  frame.object[i] = object;
}

}  // namespace

void fill_holes(const View& view, const PointImage& image, const Cells& cells, bool known,
                SurfaceImage& surface, Frame& frame) {
  PixelRays rays(view);
  mat3 to_world(view.right, view.up, view.forward);
  int width = image.width;
  parallel_ranges(image.height, 8, [&](int begin, int end) {
    thread_local Rows rows;
    Neighbours n;
    rows.stride = size_t(width) + 2 + run;
    rows.object.assign(3 * rows.stride, no_object);
    rows.albedo.assign(3 * rows.stride, 0);
    rows.depth.assign(3 * rows.stride, 0.0f);
    load_row(image, surface, frame, begin - 1, rows);
    load_row(image, surface, frame, begin, rows);
    for (int y = begin; y < end; y++) {
      load_row(image, surface, frame, y + 1, rows);
      const uint32_t* point = image.point.data() + size_t(y) * size_t(width);
      for (int x0 = 0; x0 < width; x0 += run) {
        int count = std::min(run, width - x0), holes = 0;
        for (int i = 0; i < count; i++) holes += point[x0 + i] == no_point;
        if (holes == 0) continue;
        ask_neighbours(rows, x0, y, n);
        for (int i = 0; i < count; i++) {
          int x = x0 + i;
          if (point[x] != no_point) continue;
          size_t at = size_t(y) * size_t(width) + size_t(x);
          if (n.weight[i] == 0) {
            if (known) fill_from_cells(rays, to_world, cells, x, y, at, surface, frame);
            continue;
          }
          int k = n.nearest[i];
          size_t from = size_t(y + around_y[k]) * size_t(width) + size_t(x + around_x[k]);
          float share = 1 / float(n.weight[i]);
          surface.albedo[at] = uint32_t(float(n.red[i]) * share + 0.5f) |
                               uint32_t(float(n.green[i]) * share + 0.5f) << 11 |
                               uint32_t(float(n.blue[i]) * share + 0.5f) << 22;
          surface.rest[at] = surface.rest[from];
          surface.normal[at] = surface.normal[from];
          frame.color[at] = frame.color[from];
          frame.depth[at] = n.depth[i] * share;
          frame.object[at] = n.object[i];
        }
      }
    }
  });
}

}  // namespace wellspring
