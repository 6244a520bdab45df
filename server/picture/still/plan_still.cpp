// SPDX-License-Identifier: Apache-2.0
#include "picture/still/plan_still.h"

#include "base/rng.h"
#include "base/spread.h"
#include "light/technique/pixel_requests.h"

namespace wellspring {
namespace {

// Pixel k of a square, in an order of its own, so that no direction is preferred.
ivec2 pixel_of_square(uint64_t seed, int column, int row, int k) {
  constexpr uint8_t orders[8][4] = {{0, 3, 1, 2}, {0, 3, 2, 1}, {1, 2, 0, 3}, {1, 2, 3, 0},
                                    {2, 1, 0, 3}, {2, 1, 3, 0}, {3, 0, 1, 2}, {3, 0, 2, 1}};
  uint64_t hash = mix64(seed ^ (uint64_t(uint32_t(row)) << 32 | uint32_t(column)));
  int pixel = orders[hash & 7][k];
  return {2 * column + (pixel & 1), 2 * row + (pixel >> 1)};
}

}  // namespace

void plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                std::vector<Request>& requests) {
  const int columns = (view.width + 1) / 2, rows = (view.height + 1) / 2;
  const uint64_t squares = uint64_t(columns) * uint64_t(rows);
  const uint64_t step = golden_step(uint64_t(rows));  // of rows of squares
  std::vector<PixelSample> which;
  which.reserve(size_t(count));
  for (uint64_t i = first; i < first + uint64_t(count); i++) {
    uint64_t round = i / squares, square = i % squares;
    int column = int(square % uint64_t(columns));
    int row = int(square / uint64_t(columns) * step % uint64_t(rows));
    ivec2 pixel = pixel_of_square(seed, column, row, int(round % 4));
    if (pixel.x < view.width && pixel.y < view.height)
      which.push_back({pixel.x, pixel.y, int(round / 4)});
  }
  const size_t before = requests.size();
  requests.resize(before + which.size());
  make_pixel_requests(view, seed, which, std::span(requests).subspan(before));
}

}  // namespace wellspring
