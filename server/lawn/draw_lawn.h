// SPDX-License-Identifier: Apache-2.0
// Draws a lawn into planes of a picture, which its caller lights and lays over another (Orthmann,
// Rezk-Salama, Kolb, section 6). Tiles out of sight are not drawn, far ones with fewer and wider
// blades: always the first ones of a tile's order, and the last of these become thin before they
// vanish. Strips are filled eight rows at a time. The bits are the same for any number of threads.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/simd.h"
#include "base/vec.h"
#include "lawn/fill_strips.h"
#include "lawn/lawn.h"
#include "lawn/response.h"
#include "lawn/wind.h"

namespace wellspring::lawn {

// Holds a view with orthonormal axes; pixel (0, 0) is the top left.
struct LawnView {
  vec3 eye{0};
  vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  float tan_half_fov = 0.5f;  // half of the picture's height at a depth of 1
  int width = 1, height = 1;
  vec2 axis{0.5f};    // `forward` meets the picture there, pixels
  float near = 0;     // depth from which on blades are shown
  vec2 offset{0.5f};  // sampling place in its pixel, 0 to 1
};

struct LawnDrawSettings {
  // False: a pixel shows what is at its sampling place, so that the mean of pictures with other
  // places is exact. True: a pixel is covered in part, which takes alpha-to-coverage's place while
  // something moves; strips before one another are put together about front to back.
  bool coverage = true;
  float least_width = 1;  // pixels that blades are wide in the middle, where enough stand for it
  // Depth of what else is in the picture, row by row; blades behind are not drawn. Empty: nothing.
  std::span<const float> before;
};

// One entry a pixel, row by row. Without grass depth is infinite and all else 0.
struct LawnPicture {
  int width = 0, height = 0;
  std::vector<float> depth;         // along the axis, metres; of parts: of the nearer half
  std::vector<vec3> normal;         // unit; towards the eye
  std::vector<vec3> color;          // linear reflectance
  std::vector<float> height_share;  // 0 at the root, 1 at the tip: roots have less light
  std::vector<float> sway;          // metres that a push of 1 moves it aside (lawn/shape.h)
  std::vector<float> coverage;      // share of the pixel, 0 to 1
};

struct LawnCounts {
  int tiles = 0, blades = 0;  // those in sight
};

// Keeps its memory from one picture to the next. One thread at a time.
class LawnDrawer {
 public:
  static constexpr int most_side = 8192;  // pixels; larger views get an empty picture
  LawnCounts draw(const Lawn& lawn, const LawnState& state, const Wind& wind, const LawnView& view,
                  const LawnDrawSettings& settings, LawnPicture& picture);

 private:
  struct Box {
    int16_t x0, y0, x1, y1;  // pixels, inclusive
  };
  // Holds a tile in sight, and where its strips lie.
  struct Seen {
    int tile = 0, first = 0, most = 0, count = 0;
    float depth = 0;  // its nearest place's
    ivec2 low, high;  // bins, inclusive
  };
  struct Filler;

  void find_seen(const Lawn& lawn, const LawnState& state, const LawnView& view,
                 const LawnDrawSettings& settings);
  void project(const Lawn& lawn, const LawnState& state, const WindNow& wind, const LawnView& view,
               const LawnDrawSettings& settings, Seen& seen);
  void put_in_bins();

  ivec2 bins_{0};
  std::vector<float> farthest_;  // depth in each bin that something else leaves free
  std::vector<Seen> seen_;       // the nearest first
  std::vector<Strip> strips_;
  std::vector<Box> boxes_;  // one a strip
  std::vector<int> bin_begin_, bin_seen_;
};

}  // namespace wellspring::lawn
