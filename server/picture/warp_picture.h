// SPDX-License-Identifier: Apache-2.0
// A picture of the view as it is now, made of one that was drawn for a view of a moment ago, in a
// few milliseconds: between drawn pictures, visitors see what their input does (late reprojection;
// Mark, McMillan, Bishop 1997, "Post-Rendering 3D Warping"). Backwards: every pixel looks along
// its epipolar line in the keyframe, from the nearest disparity there may be to the farthest
// (bounds of blocks, carried forward), for the first surface that it would see; where that is a
// short piece, as nearly everywhere, a step of fixed-point iteration finds it (Bowles, Mitchell,
// Sumner, Moore, Gross 2012, "Iterative Image Warping"), or none where places differ by less than
// what bilinear samples tell apart. Cores that draw meanwhile take part (base/worker.h). What a
// keyframe does not show is taken from the next, and what none shows goes on as the first has it:
// with the farthest surface on the pixel's line, so never with what stands in front, or with what
// lies at the border. Colours are bilinear within a surface. web/display/shaders.js does the same.
#pragma once
#include <span>

#include "picture/keyframe.h"

namespace wellspring::picture {

// The farthest and the nearest disparity of the new picture's blocks that a keyframe shows.
struct WarpBounds {
  std::vector<float> farthest, nearest;
};
// Kept from picture to picture to save the memory's making.
struct WarpScratch {
  std::vector<WarpBounds> bounds;  // of each keyframe
};
size_t memory_bytes(const WarpScratch& scratch);

// Overwrites `out`, of the size of `view`, and returns the share of its pixels that lie outside of
// all keyframes. When that is more than `most_unknown` (0 to 1) `out` may be left as it was.
// Keyframes in the order in which they are asked: the newest, the one before, a wide one of few
// pixels; empty ones count as none. Each passes into the next over some pixels at its border. Those
// behind cost next to nothing where the first shows all. Points behind either camera count as
// unknown; reads nothing but the keyframes whatever the views are. The same bits whatever the
// number of threads.
float warp_picture(std::span<const Keyframe* const> keyframes, const View& view, float most_unknown,
                   WarpScratch& scratch, Image8& out);
// From one, or from one and a wide one.
float warp_picture(const Keyframe& keyframe, const View& view, float most_unknown,
                   WarpScratch& scratch, Image8& out);
float warp_picture(const Keyframe& keyframe, const Keyframe& around, const View& view,
                   float most_unknown, WarpScratch& scratch, Image8& out);

}  // namespace wellspring::picture
