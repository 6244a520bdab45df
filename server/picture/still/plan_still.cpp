// SPDX-License-Identifier: Apache-2.0
#include "picture/still/plan_still.h"

#include <algorithm>

#include "base/rng.h"
#include "base/spread.h"
#include "light/technique/pixel_requests.h"

namespace wellspring::picture {
namespace {

// Pixel k of a square, in an order of its own, so that no direction is preferred.
ivec2 pixel_of_square(uint64_t seed, int column, int row, int k) {
  constexpr uint8_t orders[8][4] = {{0, 3, 1, 2}, {0, 3, 2, 1}, {1, 2, 0, 3}, {1, 2, 3, 0},
                                    {2, 1, 0, 3}, {2, 1, 3, 0}, {3, 0, 1, 2}, {3, 0, 2, 1}};
  uint64_t hash = mix64(seed ^ (uint64_t(uint32_t(row)) << 32 | uint32_t(column)));
  int pixel = orders[hash & 7][k];
  return {2 * column + (pixel & 1), 2 * row + (pixel >> 1)};
}

// Sample i of the view's sequence: where, and how often that pixel has had its turn.
struct Turn {
  ivec2 pixel;
  uint64_t before;
};
struct Turns {
  int columns, rows;  // of squares
  uint64_t step;
  uint64_t seed;
  Turns(const View& view, uint64_t seed)
      : columns((view.width + 1) / 2),
        rows((view.height + 1) / 2),
        step(golden_step(uint64_t(rows))),
        seed(seed) {}
  uint64_t squares() const { return uint64_t(columns) * uint64_t(rows); }
  Turn at(uint64_t i) const {
    uint64_t round = i / squares(), square = i % squares();
    int column = int(square % uint64_t(columns));
    int row = int(square / uint64_t(columns) * step % uint64_t(rows));
    return {pixel_of_square(seed, column, row, int(round % 4)), round / 4};
  }
};

bool is_in(const View& view, ivec2 pixel) { return pixel.x < view.width && pixel.y < view.height; }

void append_requests(const View& view, uint64_t seed, const std::vector<PixelSample>& which,
                     std::vector<Request>& requests) {
  const size_t before = requests.size();
  requests.resize(before + which.size());
  make_pixel_requests(view, seed, which, std::span(requests).subspan(before));
}

}  // namespace

void plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                std::vector<Request>& requests) {
  const Turns turns(view, seed);
  std::vector<PixelSample> which;
  which.reserve(size_t(count));
  for (uint64_t i = first; i < first + uint64_t(count); i++) {
    const Turn turn = turns.at(i);
    if (is_in(view, turn.pixel)) which.push_back({turn.pixel.x, turn.pixel.y, int(turn.before)});
  }
  append_requests(view, seed, which, requests);
}

uint64_t plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                    const PointImage& image, const StillSamples& kept,
                    std::vector<Request>& requests) {
  const Turns turns(view, seed);
  const size_t cells = size_t(weight_cells(view.width));
  std::vector<PixelSample> which;
  uint64_t i = first;
  for (; i < first + 4 * turns.squares() && which.size() < size_t(std::max(count, 0)); i++) {
    const Turn turn = turns.at(i);
    if (!is_in(view, turn.pixel)) continue;
    const size_t x = size_t(turn.pixel.x), y = size_t(turn.pixel.y);
    const size_t pixel = y * size_t(view.width) + x;
    const int known = pixel < kept.count.size() ? kept.count[pixel] : 0;
    const uint64_t weight = image.weight[y / weight_cell * cells + x / weight_cell];
    // Not all of those that count less than one in the same turn.
    const uint64_t phase = mix64(seed ^ pixel) % weight_one, done = turn.before * weight + phase;
    int samples = int((done + weight) / weight_one - done / weight_one);
    samples = std::min(samples, most_still_samples - known);
    for (int k = 0; k < samples && which.size() < size_t(count); k++)
      which.push_back({turn.pixel.x, turn.pixel.y, known + k});
  }
  append_requests(view, seed, which, requests);
  return i;
}

}  // namespace wellspring::picture
