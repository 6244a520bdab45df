// SPDX-License-Identifier: Apache-2.0
#include "cache/plan.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/rng.h"

namespace wellspring::cache {
namespace {

constexpr int band_rows = 64;  // rows dithered by one thread
// Rows dithered before without effect, to start with the usual remainders.
constexpr int warm_rows = 12;

Request make_request(const PointCache& points, const View& view, const PlanSettings& settings,
                     const PointImage& image, size_t pixel) {
  uint32_t x = uint32_t(pixel % size_t(image.width)), y = uint32_t(pixel / size_t(image.width));
  Request request;
  request.pixel = uint32_t(pixel);
  request.seed = sample_seed(settings.seed, x, y, 0);
  uint64_t random = mix64(request.seed ^ 0x706c616e);
  uint32_t point = image.point[pixel];
  // In a view at rest, one request in four still resamples its point exactly: it can show that the
  // light has changed.
  bool exact = point != no_point && (!settings.still || (random >> 62) == 0);
  if (exact) {
    vec3 position(points.x[point], points.y[point], points.z[point]);
    bool infinite = points.flags[point] & point_infinite;
    vec3 along = infinite ? position : position - view.position;
    request.ray.origin = view.position;
    request.ray.from_eye = true;
    request.ray.spread = 2 * view.tan_half_fov / float(view.height);
    request.ray.direction = normalize(along);
    request.resample = point;
  } else {
    float dx = float(random & 0xffffff) * 0x1p-24f,
          dy = float((random >> 24) & 0xffffff) * 0x1p-24f;
    request.ray = view_ray(view, float(x) + dx, float(y) + dy);
  }
  return request;
}

// Priorities and their sums are in fixed point: a step of the dither then waits for an addition and
// a shift only.
constexpr int fraction_bits = 8;

// The weights of a row's pixels; cells start at multiples of weight_cell.
struct RowWeights {
  const uint8_t* cells = nullptr;  // the row's cells; null: all count as they are
  // Returns the weight times weight_one.
  int64_t at(int x) const { return cells ? cells[x / weight_cell] : weight_one; }
};
constexpr int weight_bits = 4;
static_assert(1 << weight_bits == weight_one && weight_bits <= fraction_bits);

RowWeights weights_of_row(const PointImage& image, size_t y) {
  if (image.weight.empty()) return {};
  return {image.weight.data() + y / weight_cell * size_t(weight_cells(image.width))};
}

// Returns the sum of a row's weighted priorities, times weight_one.
uint64_t sum_of_row(const PointImage& image, size_t y) {
  const uint8_t* priority = image.priority.data() + y * size_t(image.width);
  const RowWeights weights = weights_of_row(image, y);
  uint64_t sum = 0;
  if (!weights.cells) {
    for (int x = 0; x < image.width; x++) sum += priority[x];
    return sum * weight_one;
  }
  for (int x = 0; x < image.width; x += weight_cell) {
    uint32_t cell = 0;
    for (int k = x; k < std::min(x + weight_cell, image.width); k++) cell += priority[k];
    sum += uint64_t(cell) * uint64_t(weights.at(x));
  }
  return sum;
}

// Dithers the rows [begin, end) with `share` requests to give away; returns how many it chose. A
// band whose first row started from nothing would get too little there, so its first rows are
// dithered once for practice.
template <bool weighted>
int dither_band(PointImage& image, int begin, int end, int share, int64_t threshold, uint64_t seed,
                uint32_t* chosen) {
  int width = image.width, rows = end - begin, count = 0;
  thread_local std::vector<int64_t> below;
  below.resize(size_t(width));
  uint64_t hash = mix64(seed ^ uint64_t(begin) * 0x9e3779b97f4a7c15ull);
  auto random_start = [threshold](uint64_t h) {
    return int64_t(float(h >> 40) * 0x1p-25f * float(threshold));
  };
  for (int x = 0; x < width; x++) {
    hash = hash * 6364136223846793005ull + 1442695040888963407ull;
    below[size_t(x)] = random_start(hash);
  }
  bool upwards = (seed >> 1) & 1;  // the rows that a band's share does not reach vary
  int64_t carry = random_start(mix64(hash));
  for (int i = -std::min(warm_rows, rows); i < rows; i++) {
    bool practice = i < 0;
    int line = practice ? -1 - i : i;
    size_t y = size_t(upwards ? end - 1 - line : begin + line), start = y * size_t(width);
    const RowWeights weights = weights_of_row(image, y);
    uint8_t* priority = image.priority.data() + start;
    int64_t* rest = below.data();
    int step = ((i ^ int(seed)) & 1) ? -1 : 1, x = step > 0 ? 0 : width - 1;
    for (int n = 0; n < width; n++, x += step) {
      int64_t own = int64_t(priority[x]) << fraction_bits;
      if constexpr (weighted)
        own = int64_t(priority[x]) * weights.at(x) << (fraction_bits - weight_bits);
      int64_t value = own + rest[x] + carry;
      if (value >= threshold) {
        if (priority[x] != 0) {
          if (!practice && count < share) {
            chosen[count++] = uint32_t(start + size_t(x));
            priority[x] = 0;
          }
          value -= threshold;
        }
        value = std::min(value, 2 * threshold);
      }
      carry = value >> 1;
      rest[x] = value - carry;
    }
  }
  return count;
}

// Chooses further pixels at random, by priority, until the budget is spent.
void top_up(PointImage& image, uint64_t seed, size_t budget, std::vector<uint32_t>& chosen) {
  size_t pixels = image.priority.size();
  Rng rng(mix64(seed ^ 0x746f7075));
  for (size_t tries = (budget - chosen.size()) * 16; tries > 0 && chosen.size() < budget; tries--) {
    size_t pixel = size_t(uint64_t(rng.next()) * pixels >> 32);
    uint8_t& priority = image.priority[pixel];
    if (priority == 0) continue;
    size_t width = size_t(image.width);
    int64_t weight = weights_of_row(image, pixel / width).at(int(pixel % width));
    if (priority * weight / weight_one < int64_t(rng.next() & 127)) continue;
    priority = 0;
    chosen.push_back(uint32_t(pixel));
  }
  size_t start = size_t(uint64_t(rng.next()) * pixels >> 32);
  for (size_t i = 0; i < pixels && chosen.size() < budget; i++) {
    size_t pixel = start + i < pixels ? start + i : start + i - pixels;
    if (image.priority[pixel] == 0) continue;
    image.priority[pixel] = 0;
    chosen.push_back(uint32_t(pixel));
  }
}

}  // namespace

void plan_requests(const PointCache& points, const View& view, const PlanSettings& settings,
                   PointImage& image, std::vector<Request>& requests) {
  requests.clear();
  const int height = image.height;
  size_t pixels = image.priority.size();
  size_t budget = size_t(std::max(settings.budget, 0));
  budget = std::min(budget, pixels);
  int bands = (height + band_rows - 1) / band_rows;
  if (budget == 0 || bands == 0) return;

  // The sum of a band's priorities decides its share.
  std::vector<uint64_t> sums(size_t(bands) + 1, 0);
  parallel_for(bands, [&](int band) {
    uint64_t sum = 0;
    for (int y = band * band_rows; y < std::min((band + 1) * band_rows, height); y++)
      sum += sum_of_row(image, size_t(y));
    sums[size_t(band) + 1] = sum;
  });
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
  uint64_t total = sums.back();
  if (total == 0) return;
  int64_t threshold = int64_t(double(total << (fraction_bits - weight_bits)) / double(budget));
  auto share_before = [&](int band) {
    return size_t(double(budget) * (double(sums[size_t(band)]) / double(total)));
  };

  std::vector<uint32_t> chosen(budget);
  std::vector<int> counts(static_cast<size_t>(bands));
  uint64_t seed = mix64(settings.seed);
  const auto dither = image.weight.empty() ? dither_band<false> : dither_band<true>;
  parallel_for(bands, [&](int band) {
    size_t from = share_before(band), to = band + 1 == bands ? budget : share_before(band + 1);
    int begin = band * band_rows, end = std::min(height, begin + band_rows);
    counts[size_t(band)] =
        dither(image, begin, end, int(to - from), threshold, seed, chosen.data() + from);
  });
  size_t used = 0;
  for (int band = 0; band < bands; band++) {
    size_t from = share_before(band), count = size_t(counts[size_t(band)]);
    std::copy_n(chosen.begin() + ptrdiff_t(from), count, chosen.begin() + ptrdiff_t(used));
    used += count;
  }
  chosen.resize(used);
  if (used < budget) top_up(image, seed, budget, chosen);

  requests.resize(chosen.size());
  parallel_ranges(int(chosen.size()), 512, [&](int begin, int end) {
    for (int i = begin; i < end; i++)
      requests[size_t(i)] = make_request(points, view, settings, image, chosen[size_t(i)]);
  });
}

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

// Finds the cell of each point, or the one behind the last: branch-free, so that it vectorises.
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
  // `turn` carries the old axes to the new ones; below, it becomes an axis and an angle.
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
  // Every n-th empty cell is chosen (`empty` over `chosen`), begun anywhere, and others in the next
  // picture.
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
