// SPDX-License-Identifier: Apache-2.0
#include "picture/still/still_samples.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"

namespace wellspring::picture {

namespace {

constexpr int still_drawn = 4 * still_places;  // drawn pictures that the mean looks back on

}  // namespace

void accumulate_drawn(const std::function<bool(uint32_t)>& moves, bool changes, uint32_t seed,
                      StillImage& still, Frame& frame) {
  const int longest = changes ? still_places : still_drawn;
  size_t width = size_t(frame.width);
  parallel_ranges(frame.height, 8, [&](int begin, int end) {
    uint32_t last = 0;  // neighbours mostly show the same
    bool last_moves = moves(last);
    for (size_t i = size_t(begin) * width; i < size_t(end) * width; i++) {
      if (frame.object[i] != last) last_moves = moves(last = frame.object[i]);
      if (last_moves) {
        still.count[i] = 0;
        continue;
      }
      int n = std::min(still.count[i] + 1, longest);
      vec3 mean(unpack_half(still.mean[0][i]), unpack_half(still.mean[1][i]),
                unpack_half(still.mean[2][i]));
      // Later pictures count more: their light was known better.
      mean = n == 1 ? frame.color[i] : mean + (frame.color[i] - mean) * (1.5f / (float(n) + 0.5f));
      uint64_t random = mix64(uint64_t(seed) << 32 | i);
      for (size_t c = 0; c < 3; c++)
        still.mean[c][i] = pack_half(mean[int(c)], uint32_t(random >> (16 * c)));
      still.count[i] = uint8_t(n);
      frame.color[i] = mean;
    }
  });
}

namespace {

constexpr int square_side = 8;  // pixels a side of a square that takes one share of the mean
// Samples of a pixel from which on they show their own noise: two that agree by chance say nothing.
constexpr int least_judged = 8;
constexpr int rows_at_once = 8;

int squares(int extent) { return (extent + square_side - 1) / square_side; }

// Sums over pixels: the squared difference of the mean and the picture, how much of it is the
// mean's own noise, how many pixels show this, and all pixels.
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

// Finds the mean's share with the least error, over 3x3 squares; the picture's error is taken to be
// what the two differ by beyond the mean's noise.
void find_shares(const StillSamples& samples, const std::vector<vec3>& color, ivec2 size,
                 std::vector<float>& shares) {
  const int columns = squares(size.x), rows = squares(size.y);
  std::vector<Difference> sums(size_t(columns) * size_t(rows));
  parallel_ranges(rows, 1, [&](int begin, int end) {
    for (int y = begin * square_side; y < std::min(end * square_side, size.y); y++)
      for (int x = 0; x < size.x; x++) {
        Difference one = difference_of(samples, color, size_t(y) * size_t(size.x) + size_t(x));
        sums[size_t(y / square_side) * size_t(columns) + size_t(x / square_side)].add(one);
      }
  });
  shares.resize(sums.size());
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < columns; column++) {
      Difference around;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows - 1); y++)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns - 1); x++)
          around.add(sums[size_t(y) * size_t(columns) + size_t(x)]);
      shares[size_t(row) * size_t(columns) + size_t(column)] = around.share();
    }
}

// Returns the share at a pixel: it changes gradually between the middles of squares.
float share_at(const std::vector<float>& shares, int columns, int rows, int x, int y) {
  float across = (float(x) + 0.5f) / square_side - 0.5f,
        down = (float(y) + 0.5f) / square_side - 0.5f;
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

void resize_samples(StillSamples& samples, size_t pixels) {
  samples.mean = std::vector<uint32_t>(pixels);
  samples.deviation = std::vector<uint8_t>(pixels);
  samples.count = std::vector<uint8_t>(pixels);
}

void invalidate_samples(const StillImage& still, StillSamples& samples) {
  for (size_t i = 0; i < std::min(still.count.size(), samples.count.size()); i++)
    if (still.count[i] == 0) samples.count[i] = 0;
}

void add_sample(StillSamples& samples, size_t pixel, vec3 light, uint32_t random) {
  int n = samples.count[pixel];
  vec3 mean = n > 0 ? mean_of(samples, pixel) : light, step = light - mean;
  float share = 1 / float(n + 1), square = dot(step, step) * (1 / 3.0f), variance = 0;
  if (n > 0) {
    float before = unpack_deviation(samples.deviation[pixel]);
    variance = before * before * float(n - 1) / float(n) + square * share;  // Welford 1962
  }
  samples.mean[pixel] = pack_rgb9e5(max(mean + step * share, vec3(0)), random);
  samples.deviation[pixel] = pack_deviation(std::sqrt(variance), random >> 8);
  samples.count[pixel] = uint8_t(std::min(n + 1, most_still_samples));
}

void mix_in_means(const StillSamples& samples, ivec2 size, std::vector<float>& shares,
                  std::vector<vec3>& color) {
  find_shares(samples, color, size, shares);
  parallel_ranges(size.y, rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < size.x; x++) {
        const size_t i = size_t(y) * size_t(size.x) + size_t(x);
        if (samples.count[i] == 0) continue;
        const float share = share_at(shares, squares(size.x), squares(size.y), x, y);
        color[i] += (mean_of(samples, i) - color[i]) * share;
      }
  });
}

}  // namespace wellspring::picture
