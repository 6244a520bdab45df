// SPDX-License-Identifier: Apache-2.0
// A picture of the view as it is now, made of one that was drawn for a view of a moment ago, in a
// few milliseconds: between drawn pictures, visitors see what their input does (late reprojection;
// Mark, McMillan, Bishop 1997, "Post-Rendering 3D Warping"). Backwards: every pixel looks along
// its epipolar line in the keyframe, from the nearest disparity there may be to the farthest
// (bounds of blocks, carried forward), for the first surface that it would see; where that is a
// short piece, as nearly everywhere, a step of fixed-point iteration finds it (Bowles, Mitchell,
// Sumner, Moore, Gross 2012, "Iterative Image Warping"), or none where places differ by less than
// what bilinear samples tell apart. Cores that draw meanwhile take part (base/priority.h). What was
// hidden in the keyframe takes the colour of the farthest surface on its line, never that of what
// hid it; web/display does the same. Colours are bilinear within a surface.
#pragma once
#include <cstdint>
#include <vector>

#include "picture/keyframe.h"

namespace wellspring {

// Kept from picture to picture to save the memory's making: bounds of disparities of the new
// picture's blocks.
struct WarpScratch {
  std::vector<float> farthest, nearest;
  // Bits of eight pixels side by side each: not within the keyframe, and near its border.
  std::vector<uint8_t> outside, at_seam;
  std::vector<uint8_t> share;  // of 255, that the keyframe has in such pixels
};
size_t memory_bytes(const WarpScratch& scratch);

// Overwrites `out`, of the size of `view`, and returns the share of its pixels that the keyframe
// does not show, as they lie outside of it: those continue its border. When that is more than
// `most_unknown` (0 to 1) `out` may be left as it was or half done. Points behind either camera
// count as unknown; reads nothing but the keyframe whatever the views are. The same bits whatever
// the number of threads.
float warp_picture(const Keyframe& keyframe, const View& view, float most_unknown,
                   WarpScratch& scratch, Image8& out);
// What lies outside of the keyframe is taken from `around`, of a wider view and of fewer pixels,
// into which the keyframe passes over some pixels at its border; the share returned is of what
// neither shows. Costs nothing where the keyframe shows all.
float warp_picture(const Keyframe& keyframe, const Keyframe& around, const View& view,
                   float most_unknown, WarpScratch& scratch, Image8& out);

}  // namespace wellspring
