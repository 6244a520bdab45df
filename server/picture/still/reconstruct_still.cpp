// SPDX-License-Identifier: Apache-2.0
#include "picture/still/reconstruct_still.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "cache/packing.h"

namespace wellspring {
namespace {

constexpr float prior_weight = 0.5f;  // samples that the drawn picture counts as
constexpr int square = 8;             // pixels a side of what takes one share of the mean
// Samples of a pixel from which on they tell their own noise: two that agree by chance say nothing.
constexpr int least_judged = 8;
constexpr int rows_at_once = 8;

int squares(int extent) { return (extent + square - 1) / square; }

vec3 mean_of(const StillSamples& samples, size_t pixel) {
  return unpack_rgb9e5(samples.mean[pixel]);
}

// Of squares of pixels: what the mean and the reconstruction differ by, squared, how much of that
// the mean's own noise is, and how many of the pixels tell.
struct Difference {
  float squared = 0, noise = 0, judged = 0, pixels = 0;
  void add(const Difference& other) {
    squared += other.squared, noise += other.noise;
    judged += other.judged, pixels += other.pixels;
  }
  float share() const {
    if (2 * judged < pixels || !(squared > 0)) return 0;
    return std::max(1 - noise / squared, 0.0f);
  }
};

Difference difference_of(const StillSamples& samples, const std::vector<vec3>& color,
                         size_t pixel) {
  const int n = samples.count[pixel];
  if (n < least_judged) return {0, 0, 0, 1};
  float deviation = unpack_deviation(samples.deviation[pixel]);
  vec3 apart = mean_of(samples, pixel) - color[pixel];
  return {dot(apart, apart) * (1 / 3.0f), deviation * deviation / float(n), 1, 1};
}

// The mean's share with the least error where the reconstruction's is what the two differ by beyond
// the mean's noise (James and Stein 1961), over 3x3 squares.
void find_shares(const StillSamples& samples, StillReconstruction& work) {
  const int columns = squares(work.width), rows = squares(work.height);
  std::vector<Difference> sums(size_t(columns) * size_t(rows));
  parallel_ranges(rows, 1, [&](int begin, int end) {
    for (int y = begin * square; y < std::min(end * square, work.height); y++)
      for (int x = 0; x < work.width; x++) {
        Difference one =
            difference_of(samples, work.color, size_t(y) * size_t(work.width) + size_t(x));
        sums[size_t(y / square) * size_t(columns) + size_t(x / square)].add(one);
      }
  });
  work.shares.resize(sums.size());
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < columns; column++) {
      Difference around;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows - 1); y++)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns - 1); x++)
          around.add(sums[size_t(y) * size_t(columns) + size_t(x)]);
      work.shares[size_t(row) * size_t(columns) + size_t(column)] = around.share();
    }
}

// Between the middles of squares, shares pass from one to the other.
float share_at(const std::vector<float>& shares, int columns, int rows, int x, int y) {
  float across = (float(x) + 0.5f) / square - 0.5f, down = (float(y) + 0.5f) / square - 0.5f;
  int left = int(std::floor(across)), top = int(std::floor(down));
  auto at = [&](int column, int row) {
    return shares[size_t(std::clamp(row, 0, rows - 1)) * size_t(columns) +
                  size_t(std::clamp(column, 0, columns - 1))];
  };
  float u = across - float(left), v = down - float(top);
  return glm::mix(glm::mix(at(left, top), at(left + 1, top), u),
                  glm::mix(at(left, top + 1), at(left + 1, top + 1), u), v);
}

}  // namespace

size_t memory_bytes(const StillReconstruction& work) {
  return bytes_of(work.guides.albedo, work.guides.normal, work.followed, work.color, work.shares);
}

double mean_count(const StillSamples& samples) {
  if (samples.count.empty()) return 0;
  std::atomic<uint64_t> sum{0};
  parallel_ranges(int(samples.count.size()), 1 << 16, [&](int begin, int end) {
    uint64_t here = 0;
    for (size_t i = size_t(begin); i < size_t(end); i++) here += samples.count[i];
    sum += here;
  });
  return double(sum) / double(samples.count.size());
}

void begin_reconstruction(const StillSamples& samples, const Frame& drawn, Denoiser& denoiser,
                          StillReconstruction& work) {
  const size_t pixels = drawn.color.size();
  work.width = drawn.width, work.height = drawn.height;
  work.color.resize(pixels);
  parallel_ranges(int(pixels), 1 << 14, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      float n = samples.count[i];
      work.color[i] = drawn.color[i];
      const float share = n / (n + prior_weight);
      if (n > 0) work.color[i] += (mean_of(samples, i) - drawn.color[i]) * share;
    }
  });
  denoiser.start({work.width, work.height, work.color, work.guides.albedo, work.guides.normal});
}

void finish_reconstruction(const StillSamples& samples, const Denoiser& denoiser,
                           StillReconstruction& work, Frame& frame) {
  denoiser.finish(work.color);
  const int columns = squares(work.width), rows = squares(work.height);
  find_shares(samples, work);
  parallel_ranges(work.height, rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < work.width; x++) {
        size_t i = size_t(y) * size_t(work.width) + size_t(x);
        vec3 found = work.color[i];
        if (samples.count[i] > 0)
          found += (mean_of(samples, i) - found) * share_at(work.shares, columns, rows, x, y);
        frame.color[i] = found;
      }
  });
}

}  // namespace wellspring
