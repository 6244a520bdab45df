// SPDX-License-Identifier: Apache-2.0
#include "attention/pyramid.h"

#include <algorithm>

#include "base/parallel.h"

namespace wellspring::attention {
namespace {

// Rows of which a thread takes no fewer: less than that is done before another thread wakes up.
int row_grain(int width) { return 1 + (1 << 14) / (width + 1); }

// Six taps of even sides, five of odd ones. Symmetric pairs are added first: the mirrored taps give
// the same bits.
struct EvenTaps {
  static float eval(float a, float b, float c, float d, float e, float f) {
    return 10 / 32.0f * (c + d) + 5 / 32.0f * (b + e) + 1 / 32.0f * (a + f);
  }
};
struct OddTaps {
  static float eval(float a, float b, float c, float d, float e, float) {
    return 6 / 16.0f * c + 4 / 16.0f * (b + d) + 1 / 16.0f * (a + e);
  }
};

template <class Taps>
void filter_row(const float* __restrict fine, int count, float* __restrict coarse) {
  for (int i = 0; i < count; i++) {
    const float* at = fine + 2 * i;
    coarse[i] = Taps::eval(at[0], at[1], at[2], at[3], at[4], at[5]);
  }
}

template <class Taps>
void filter_rows(const Plane& narrow, int y, float* __restrict coarse) {
  const float* tap[6];
  for (int i = 0; i < 6; i++) tap[i] = narrow.row(std::clamp(2 * y - 2 + i, 0, narrow.height - 1));
  for (int x = 0; x < narrow.width; x++)
    coarse[x] = Taps::eval(tap[0][x], tap[1][x], tap[2][x], tap[3][x], tap[4][x], tap[5][x]);
}

void reduce_row(const float* fine, int width, float* coarse) {
  float piece[fine_piece_size];
  for (int begin = 0; begin < half_size(width); begin += piece_size) {
    int count = std::min(piece_size, half_size(width) - begin), left = 2 * begin - 2;
    int from = std::max(left, 0), to = std::min(left + 2 * count + 4, width);
    std::fill(piece, piece + (from - left), fine[0]);
    std::copy(fine + from, fine + to, piece + (from - left));
    std::fill(piece + (to - left), piece + 2 * count + 4, fine[width - 1]);
    reduce_piece(piece, width, count, coarse + begin);
  }
}

// Two coarser pixels and the second one's share, for a pixel of a side of that many.
struct Between {
  int a, b;
  float share;
};
Between find_between(int x, int size) {
  int last = half_size(size) - 1;
  if (size % 2 != 0) return {x / 2, std::min((x + 1) / 2, last), 0.5f};
  return x % 2 == 0 ? Between{std::max(x / 2 - 1, 0), x / 2, 0.75f}
                    : Between{x / 2, std::min(x / 2 + 1, last), 0.25f};
}

void expand_row(const float* __restrict coarse, int width, float* __restrict fine) {
  auto edge = [&](int x) {
    Between at = find_between(x, width);
    fine[x] = (1 - at.share) * coarse[at.a] + at.share * coarse[at.b];
  };
  if (width % 2 == 0) {
    edge(0);
    for (int i = 0; i < width / 2 - 1; i++) {
      fine[2 * i + 1] = 0.75f * coarse[i] + 0.25f * coarse[i + 1];
      fine[2 * i + 2] = 0.25f * coarse[i] + 0.75f * coarse[i + 1];
    }
    edge(width - 1);
    return;
  }
  for (int i = 0; i < width / 2; i++) {
    fine[2 * i] = coarse[i];
    fine[2 * i + 1] = 0.5f * (coarse[i] + coarse[i + 1]);
  }
  edge(width - 1);
}

}  // namespace

void reduce_piece(const float* fine, int size, int count, float* coarse) {
  if (size % 2 == 0) filter_row<EvenTaps>(fine, count, coarse);
  else filter_row<OddTaps>(fine, count, coarse);
}

void reduce_rows(const Plane& narrow, Plane& coarse) {
  fit_plane(narrow.width, half_size(narrow.height), coarse);
  parallel_ranges(coarse.height, row_grain(coarse.width), [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      if (narrow.height % 2 == 0) filter_rows<EvenTaps>(narrow, y, coarse.row(y));
      else filter_rows<OddTaps>(narrow, y, coarse.row(y));
  });
}

void reduce(const Plane& fine, Plane& narrow, Plane& coarse) {
  fit_plane(half_size(fine.width), fine.height, narrow);
  parallel_ranges(fine.height, row_grain(fine.width), [&](int begin, int end) {
    for (int y = begin; y < end; y++) reduce_row(fine.row(y), fine.width, narrow.row(y));
  });
  reduce_rows(narrow, coarse);
}

void expand(const Plane& coarse, int width, int height, Plane& narrow, Plane& fine) {
  fit_plane(width, coarse.height, narrow);
  for (int y = 0; y < coarse.height; y++) expand_row(coarse.row(y), width, narrow.row(y));
  fit_plane(width, height, fine);
  for (int y = 0; y < height; y++) {
    Between at = find_between(y, height);
    const float *above = narrow.row(at.a), *below = narrow.row(at.b);
    float* to = fine.row(y);
    for (int x = 0; x < width; x++) to[x] = (1 - at.share) * above[x] + at.share * below[x];
  }
}

}  // namespace wellspring::attention
