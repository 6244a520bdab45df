// SPDX-License-Identifier: Apache-2.0
// The sqrt(5) hierarchy of sampling places (Haber, Myszkowski, Yamauchi, Seidel 2001, section 4.3,
// after Stamminger, Drettakis 2001): square grids, each 1/sqrt(5) as wide as the one before and
// turned by atan(1/2). All are turned and scaled so that the last grid is that of the pixels. Then
// every place is a whole pixel, and every pixel is a place of one level only. Levels count from 1,
// the coarsest. The grids are fixed to the picture, so regions that overlap share their places.
//
// All is integer arithmetic. With pixels as complex numbers the last step is 1, and each level's
// step is (2 - i) times that of the next.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace wellspring::test {

// Pixels from (x0, y0) up to, but without, (x1, y1).
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  bool operator==(const PixelBox&) const = default;
};

inline constexpr int most_sqrt5_levels = 12;

// Places of level l are i * u + j * v with u = step[l - 1] and v = (-u.y, u.x), without those of
// levels before. |u| = sqrt(5)^(levels - l), the first of which is the paper's h.
struct Sqrt5Grid {
  int levels = 1;
  std::array<ivec2, most_sqrt5_levels> step{};
};
// Makes the grids. With 4 or 8 levels the first grid is nearly upright, and its footprints leave
// few pixels out: 3 and 1 of a hundred. `levels` is cut off to 1 up to most_sqrt5_levels.
Sqrt5Grid make_sqrt5_grid(int levels);

// Returns the side of a level's square footprint in pixels: the paper's s_l, here max(|u.x|,
// |u.y|), exactly. Footprints of one level do not overlap, and none covers the place of a coarser
// level; so pixels that are splatted level by level, coarse to fine, end with their own samples.
// Between a level's footprints there are squares of side min(|u.x|, |u.y|), which show coarser
// levels.
inline int footprint_side(const Sqrt5Grid& grid, int level) {
  ivec2 u = glm::abs(grid.step[size_t(level - 1)]);
  return glm::max(u.x, u.y);
}
// The one level that this pixel is a place of.
int level_of_pixel(const Sqrt5Grid& grid, ivec2 pixel);

// The places of one level in a box, row by row of the level's own grid, without recursion. A value
// that can be kept and continued: `position` counts the places that were passed, as the iterator
// position of the paper's load balancing does (section 4.4).
class Sqrt5Places {
 public:
  Sqrt5Places() = default;  // none
  // Starts at place `position` of the level; O(rows).
  Sqrt5Places(const Sqrt5Grid& grid, int level, const PixelBox& box, int64_t position = 0);
  bool next(ivec2& place);  // false: there are no more
  int64_t position() const { return position_; }
  int64_t count() const;  // number of the level's places in the box; O(rows)

 private:
  struct Row {
    int64_t begin = 0, end = -1;  // the first and the last i
    int64_t omitted = -1;         // i modulo 5 that belongs to a coarser level; -1: none does
    int64_t count() const;
  };
  Row row(int64_t j) const;

  PixelBox box_;
  int64_t a_ = 1, b_ = 0;  // u
  bool coarsest_ = true;
  int64_t j_begin_ = 0, j_end_ = -1, j_ = 0;  // rows, the last included
  int64_t i_ = 0;                             // next in the row
  Row row_;
  int64_t position_ = 0;
};

// Appends at most `count` places from `position` on.
void list_places(const Sqrt5Grid& grid, int level, const PixelBox& box, int64_t position,
                 int64_t count, std::vector<ivec2>& places);

}  // namespace wellspring::test
