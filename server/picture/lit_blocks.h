// SPDX-License-Identifier: Apache-2.0
// Holds the light on what is laid over a picture: found once for each block of pixels, and read
// between four of them, as far as they lie on the same surface.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/simd.h"
#include "light/virtual/direct_light.h"
#include "light/visible/surface_buffer.h"
#include "picture/cells/cells.h"
#include "world/view.h"

namespace wellspring::picture {

// Holds the light on a block of pixels, as a surface there that faces along `normal` gets it.
struct LitBlock {
  vec3 light{0}, slope{0}, normal{0};
  float depth = 0;  // metres along the axis; 0: the block shows nothing whose light is known
};

class LitBlocks {
 public:
  static constexpr int side = 4;  // pixels

  // Begins a picture whose pixels are seen at `offset` in them. Light is found in `window` alone.
  void begin(const View& view, vec2 offset, const PictureWindow& window);
  // Finds each block's light at one of its pixels, the nearest to its middle that shows anything.
  // It faces as a few pixels around do, those that look at the eye the most: on a floor that is
  // seen along itself noise turns single normals away from the eye, and so upside down.
  // depth_at(x, y): metres along the axis; normal_at(x, y): unit; light(place, block): sets light
  // and slope for block.normal, place in scene coordinates, and returns false if it knows none.
  template <class Depth, class Normal, class Light>
  void fill(const Depth& depth_at, const Normal& normal_at, const Light& light);
  // Returns the light on eight pixels from (x, y) on; `usual` where none is known.
  Lanes3 at(int x, int y, const Lanes& depth, const Lanes3& normal, float usual) const;
  // Returns whether light is known near any of them.
  bool reach(int x, int y) const;

  // Describes blocks as the pixels of a picture; those of which nothing is known show nothing.
  // `lift`: metres at which shadow rays begin.
  void describe(float lift, SurfaceBuffer& surfaces) const;
  // Adds such a picture's light.
  void add(const LightPlanes& light);
  size_t memory_bytes() const { return bytes_of(blocks_); }

 private:
  template <class Depth, class Normal, class Light>
  void fill_one(const PixelGrid& grid, int column, int row, const Depth& depth_at,
                const Normal& normal_at, const Light& light);

  View view_;
  vec2 offset_{0.5f};
  PictureWindow window_;
  int columns_ = 0, rows_ = 0;
  std::vector<LitBlock> blocks_;
};

namespace lit_blocks {
inline constexpr int most_normals = 6;     // a block's normal is the mean of so many
inline constexpr float most_step = 0.04f;  // from a pixel to its block, as a share of the depth
inline constexpr std::array<glm::ivec2, 16> nearest_first = {{{2, 2},
                                                              {1, 1},
                                                              {2, 1},
                                                              {1, 2},
                                                              {3, 2},
                                                              {2, 3},
                                                              {0, 1},
                                                              {1, 0},
                                                              {3, 1},
                                                              {1, 3},
                                                              {0, 2},
                                                              {2, 0},
                                                              {3, 3},
                                                              {0, 0},
                                                              {3, 0},
                                                              {0, 3}}};
}  // namespace lit_blocks

template <class Depth, class Normal, class Light>
void LitBlocks::fill_one(const PixelGrid& grid, int column, int row, const Depth& depth_at,
                         const Normal& normal_at, const Light& light) {
  LitBlock& lit = blocks_[size_t(row) * size_t(columns_) + size_t(column)];
  vec3 place(0);
  float first = 0;
  int known = 0;
  for (const glm::ivec2 from : lit_blocks::nearest_first) {
    const int x = column * side + from.x, y = row * side + from.y;
    if (x >= view_.width || y >= view_.height) continue;
    const float depth = depth_at(x, y);
    if (!std::isfinite(depth)) continue;
    const vec3 way = grid.at(float(x), float(y));
    if (known == 0) first = depth, place = depth * way;
    if (std::abs(depth - first) > lit_blocks::most_step * first) continue;
    const vec3 normal = normal_at(x, y);
    lit.normal -= normal * dot(normal, glm::normalize(way));
    if (++known == lit_blocks::most_normals) break;
  }
  const float length = glm::length(lit.normal);
  if (!(length > 0)) return;
  lit.normal /= length;
  if (light(view_.position + place, lit)) lit.depth = first;
}

template <class Depth, class Normal, class Light>
void LitBlocks::fill(const Depth& depth_at, const Normal& normal_at, const Light& light) {
  const PixelGrid grid(view_, offset_);
  const int left = window_.left / side, top = window_.top / side;
  const int right = std::min((window_.left + window_.width + side - 1) / side, columns_),
            bottom = std::min((window_.top + window_.height + side - 1) / side, rows_);
  parallel_each(bottom - top, [&](int row) {
    for (int column = left; column < right; column++)
      fill_one(grid, column, top + row, depth_at, normal_at, light);
  });
}

}  // namespace wellspring::picture
