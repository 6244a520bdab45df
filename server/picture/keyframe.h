// SPDX-License-Identifier: Apache-2.0
// A picture as it was drawn, with the depth of every pixel: what warp_picture() makes pictures of
// other views from. In place of the depth its inverse is kept, the disparity: of a plane it is
// linear in the picture, and what moves against what when the eye moves is proportional to it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "frame/frame.h"
#include "world/view.h"

namespace wellspring::picture {

struct Keyframe {
  static constexpr int block = 8;            // pixels a side
  static constexpr float step_scale = 4096;  // steps a unit of disparity
  View view;                                 // whose size is the picture's
  // Red in the lowest byte, then green, blue and the step: how far apart the disparities of this
  // pixel and those to its right, below, and both are, times step_scale, rounded up, at most 255.
  // One pixel more than there are, since they are read in pairs; disparities likewise.
  std::vector<uint32_t> color;
  std::vector<float> disparity;  // 1 / depth; 0 at infinity and where the depth is none
  // Of blocks, row after row: the pixels and those around them.
  int columns = 0, rows = 0;
  std::vector<float> farthest, nearest;

  bool empty() const { return color.empty(); }
};
size_t memory_bytes(const Keyframe& keyframe);

// The view with some of what lies around, in pixels of the same size: what is drawn of it for
// warps. To the sides so much that it may turn by `turn` radians, within a tenth of its width.
View keyframe_view(View view, float turn = 0);

// The same in larger pixels: sides of `scale` times as many.
View scaled_view(View view, float scale);

// One view of all that several of nearly the same place show, in their middle direction and as wide
// as it takes, within what a flat picture can hold; about `share` of the first one's pixels, and no
// larger than that to any side. No views: an empty one.
View surrounding_view(std::span<const View> views, float share);

// The unit in which a display is told disparities of the view (frame/disparity_code.h): they are
// off by at most half a pixel of parallax for each metre that the eye moves.
float disparity_unit(const View& view);

// The share of the picture that appears anew beside what is nearer, for a metre that the eye moves.
float uncovered_a_metre(const Keyframe& keyframe);

// Reuses the memory of `keyframe`. `depth`: along the viewing axis, one a pixel, as Frame::depth;
// anything that is not a positive number counts as infinitely far. Throws std::invalid_argument
// when sizes differ.
void make_keyframe(const View& view, const Image8& picture, std::span<const float> depth,
                   Keyframe& keyframe);

}  // namespace wellspring::picture
