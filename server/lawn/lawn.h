// SPDX-License-Identifier: Apache-2.0
// A lawn: blades of grass that grow where pictures say (Orthmann, Rezk-Salama, Kolb, "GPU-based
// Responsive Grass", section 4). The paper's billboards show a clump each, since a graphics card
// fills pixels sooner than it makes triangles. Here an eye stands in the grass and a processor
// draws it, which sees billboards to be flat and reads their textures slowly; so each blade is a
// tapered strip of its own. Values of blades lie in columns, tile by tile.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "image/image.h"

namespace wellspring::lawn {

// A blade's strip has this many segments and one joint more; the first joint is the root.
inline constexpr int segments = 3, joints = segments + 1;

// A picture over the lawn, or one value for all of it. Columns of the picture go to +x, rows to +z;
// codes are read as they stand, 0 to 1, between pixels bilinearly.
struct LawnMap {
  vec3 constant{1};
  std::shared_ptr<const ImageCodes> picture;  // null, or no pixels: `constant`
  vec3 at(vec2 share) const;                  // share of the rectangle, 0 to 1
};

// Linear reflectances; they change from root to tip, and from fresh blades to dry ones.
struct LawnColors {
  vec3 root{0.045f, 0.07f, 0.015f}, fresh{0.10f, 0.22f, 0.035f}, dry{0.34f, 0.29f, 0.10f};
  float dryness = 0.35f;       // share of `dry` in the driest blade's tip, 0 to 1
  float transmission = 0.35f;  // share of the light through a blade to that which it reflects
};

struct LawnDescription {
  vec2 low{0}, high{1};  // corners of the rectangle, x and z, metres
  // Returns the ground's y at (x, z), or NaN where nothing grows. Asked once a blade, in order.
  std::function<float(float x, float z)> ground = [](float, float) { return 0.0f; };
  float density = 800;                          // blades a square metre where `extent` is 1
  float height = 0.18f, height_spread = 0.35f;  // metres; share by which blades are shorter at most
  float width = 0.006f;                         // metres at the widest
  float droop = 0.7f;  // how far tips hang over: 0 is straight, 1 about 40 degrees
  // How likely grass grows (red); the direction in which it grows, x, y and z as 2 * code - 1; the
  // share of chance in a blade's direction and droop (red).
  LawnMap extent, direction{vec3(0.5f, 1, 0.5f), nullptr}, messiness{vec3(0.4f), nullptr};
  LawnColors colors;
  uint64_t seed = 1;
  int most_blades = 2'000'000;  // more become sparser all over
};

// Owns the blades [begin, begin + count). `begin` is a multiple of eight; blades up to the next
// multiple are of no height. Order within a tile is random, so that the first few of its blades
// stand for all.
struct LawnTile {
  int begin = 0, count = 0;
  vec3 low{0}, high{0};  // around blades that only the wind moves
  float widest = 0;      // metres, of a blade
  vec2 slope{0};         // metres that the ground rises a metre of x and of z
};

// Immutable once made. Columns have one entry a blade.
struct Lawn {
  vec2 low{0}, high{0};
  float tile_side = 1;
  ivec2 tiles{0};                             // columns to +x, rows to +z
  std::vector<LawnTile> tile;                 // row by row
  std::vector<float> x, y, z;                 // roots
  std::vector<float> grow_x, grow_y, grow_z;  // unit
  std::vector<float> side_x, side_z;          // unit, level: from edge to edge of the strip
  std::vector<float> length, width;           // metres
  std::vector<float> droop;                   // how far the tip hangs over, across the side
  std::vector<float> dry;                     // 0 to 1
  std::vector<float> give;                    // how much wind moves it, about 1
  int blades = 0;                             // without those that fill up tiles
  float tallest = 0;                          // metres
  LawnColors colors;
};

// Makes the same blades of the same description. Numbers that are not finite or not in their range
// are as the nearest that are; an empty rectangle has no blades.
Lawn make_lawn(const LawnDescription& description);

}  // namespace wellspring::lawn
