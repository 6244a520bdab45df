// SPDX-License-Identifier: Apache-2.0
// Gaussian pyramids (Burt, Adelson 1983): each scale is the one before, low-pass filtered and of
// half its size, odd sizes rounded up. A side of even length is filtered by the binomial
// (1 5 10 10 5 1)/32, whose pixels lie between two finer ones; one of odd length by (1 4 6 4 1)/16,
// whose pixels lie on every second finer one. So a mirrored plane has a mirrored pyramid, whatever
// its size. Beyond its border a plane goes on as at the border.
#pragma once
#include <vector>

#include "base/vec.h"

namespace wellspring::attention {

// One number a pixel, top row first.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> value;
  float* row(int y) { return value.data() + size_t(y) * size_t(width); }
  const float* row(int y) const { return value.data() + size_t(y) * size_t(width); }
};
// What the plane holds afterwards means nothing.
inline void fit_plane(int width, int height, Plane& plane) {
  plane.width = width;
  plane.height = height;
  plane.value.resize(size_t(width) * size_t(height));
}

inline int half_size(int size) { return (size + 1) / 2; }
// Where pixel `x` of a side of that many pixels lies at the next coarser scale.
inline float coarser_place(float x, int size) {
  return size % 2 == 0 ? 0.5f * x - 0.25f : 0.5f * x;
}

// `count` neighbours of a filtered row, at most piece_size, of a side of `size` pixels. The first
// lies at pixel 2 i of the finer row or just right of it, and `fine` holds that row from pixel
// 2 i - 2 on, 2 * count + 4 of them.
inline constexpr int piece_size = 128, fine_piece_size = 2 * piece_size + 4;
void reduce_piece(const float* fine, int size, int count, float* coarse);
// Rows that are filtered so become the next scale.
void reduce_rows(const Plane& narrow, Plane& coarse);

// The next coarser scale. `narrow` is scratch.
void reduce(const Plane& fine, Plane& narrow, Plane& coarse);
// The next finer scale of that size, interpolated linearly: what reduce() put where, from there.
// `narrow` is scratch.
void expand(const Plane& coarse, int width, int height, Plane& narrow, Plane& fine);

}  // namespace wellspring::attention
