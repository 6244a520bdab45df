// SPDX-License-Identifier: Apache-2.0
#include "cache/predict.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"

namespace wellspring::cache {
namespace {

constexpr float near_depth = 1e-4f;  // metres, as in project_points()
constexpr int chunk = 4096;

int cells_across(int pixels) { return (pixels + cell_pixels - 1) / cell_pixels; }

struct Grid {
  int columns, rows;
  float focal;
  vec2 axis;
  explicit Grid(const View& view)
      : columns(cells_across(view.width)),
        rows(cells_across(view.height)),
        focal(float(view.height) * 0.5f / view.tan_half_fov / cell_pixels),
        axis(axis_place(view) / float(cell_pixels)) {}
};

// The cell of each point, or the one behind the last: branch-free, so that it vectorises.
void place_chunk(const PointCache& points, const View& view, const Grid& grid, int begin, int count,
                 int32_t* __restrict cell) {
  const float* px = points.x.data() + begin;
  const float* py = points.y.data() + begin;
  const float* pz = points.z.data() + begin;
  const uint8_t* flags = points.flags.data() + begin;
  const uint8_t* age = points.age.data() + begin;
  float columns = float(grid.columns), rows = float(grid.rows);
  int32_t nowhere = grid.columns * grid.rows;
  const float near = std::max(view.near, near_depth);
  for (int i = 0; i < count; i++) {
    int32_t flag = flags[i], infinite = (flag >> 1) & 1;
    float here = float(1 - infinite);
    float dx = px[i] - view.position.x * here, dy = py[i] - view.position.y * here,
          dz = pz[i] - view.position.z * here;
    float depth = dx * view.forward.x + dy * view.forward.y + dz * view.forward.z;
    float across = dx * view.right.x + dy * view.right.y + dz * view.right.z;
    float above = dx * view.up.x + dy * view.up.y + dz * view.up.z;
    float scale = grid.focal / depth;
    float sx = across * scale + grid.axis.x, sy = grid.axis.y - above * scale;
    int32_t good = int32_t(depth > near) & int32_t(sx >= 0.0f) & int32_t(sx < columns) &
                   int32_t(sy >= 0.0f) & int32_t(sy < rows) & int32_t(age[i] != evicted_age) & flag;
    float cx = sx > 0.0f ? sx : 0.0f, cy = sy > 0.0f ? sy : 0.0f;
    cx = cx < columns ? cx : 0.0f;
    cy = cy < rows ? cy : 0.0f;
    cell[i] = good ? int32_t(cy) * grid.columns + int32_t(cx) : nowhere;
  }
}

}  // namespace

View extrapolate(const View& before, const View& now, float steps) {
  if (before.width != now.width || before.height != now.height ||
      before.tan_half_fov != now.tan_half_fov)
    return now;
  // The rotation that carries the old axes to the new ones, as axis times angle.
  mat3 turn = mat3(now.right, now.up, now.forward) *
              glm::transpose(mat3(before.right, before.up, before.forward));
  vec3 axis(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
  float sine = 0.5f * length(axis), cosine = 0.5f * (turn[0][0] + turn[1][1] + turn[2][2] - 1);
  float angle = std::atan2(sine, cosine);
  vec3 step = now.position - before.position;
  if (!is_finite(step) || !(angle <= largest_turn)) return now;
  View ahead = now;
  ahead.position += step * steps;
  ahead.middle += (now.middle - before.middle) * steps;
  if (sine < 1e-6f) return ahead;
  axis = normalize(axis);
  angle *= steps;
  auto rotated = [&](vec3 v) {
    return v * std::cos(angle) + cross(axis, v) * std::sin(angle) +
           axis * (dot(axis, v) * (1 - std::cos(angle)));
  };
  ahead.forward = normalize(rotated(now.forward));
  ahead.right = normalize(cross(ahead.forward, rotated(now.up)));
  ahead.up = cross(ahead.right, ahead.forward);
  return ahead;
}

void find_occupied(const PointCache& points, const View& ahead, std::vector<uint8_t>& cells) {
  Grid grid(ahead);
  cells.assign(size_t(grid.columns) * size_t(grid.rows) + 1, 0);
  parallel_ranges((points.capacity() + chunk - 1) / chunk, 4, [&](int begin, int end) {
    int32_t where[chunk];
    for (int c = begin; c < end; c++) {
      int first = c * chunk, count = std::min(chunk, points.capacity() - first);
      place_chunk(points, ahead, grid, first, count, where);
      for (int i = 0; i < count; i++)
        std::atomic_ref<uint8_t>(cells[size_t(where[i])]).store(1, std::memory_order_relaxed);
    }
  });
  cells.pop_back();
}

void predict_requests(const PointCache& points, const View& ahead, int most, uint64_t seed,
                      std::vector<uint8_t>& cells, std::vector<Request>& requests) {
  if (most <= 0) return;
  find_occupied(points, ahead, cells);
  size_t empty = size_t(std::count(cells.begin(), cells.end(), uint8_t(0)));
  if (empty == 0) return;
  size_t chosen = std::min(empty, size_t(most)), columns = size_t(cells_across(ahead.width));
  // Steps of `empty` over `chosen`, begun anywhere: every n-th, and others in the next picture.
  uint64_t random = mix64(seed ^ 0x70726564);
  size_t sum = size_t(random % empty);
  for (size_t cell = 0; cell < cells.size(); cell++) {
    if (cells[cell]) continue;
    sum += chosen;
    if (sum < empty) continue;
    sum -= empty;
    uint32_t x = uint32_t(cell % columns), y = uint32_t(cell / columns);
    Request request;
    request.pixel = no_pixel;
    request.seed = sample_seed(seed, x, y, 1);
    uint64_t place = mix64(request.seed);
    float u = float(place & 0xffffff) * 0x1p-24f, v = float((place >> 24) & 0xffffff) * 0x1p-24f;
    request.ray = view_ray(ahead, std::min((float(x) + u) * cell_pixels, float(ahead.width)),
                           std::min((float(y) + v) * cell_pixels, float(ahead.height)));
    requests.push_back(request);
  }
}

}  // namespace wellspring::cache
