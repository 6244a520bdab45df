// SPDX-License-Identifier: Apache-2.0
// Makes a picture of the view as it is now from one that was drawn for a view of a moment ago, in a
// few milliseconds: between drawn pictures, visitors see what their input does (late reprojection;
// Mark, McMillan, Bishop 1997, "Post-Rendering 3D Warping"). Warping goes backwards: every pixel
// looks along its epipolar line in the keyframe, from the nearest disparity there may be to the
// farthest (bounds of blocks, carried forward), for the first surface that it would see; if that is
// a short piece, as nearly everywhere, a step of fixed-point iteration finds it (Bowles, Mitchell,
// Sumner, Moore, Gross 2012, "Iterative Image Warping"), or none if places differ by less than
// bilinear samples resolve. Cores that draw meanwhile take part (base/worker.h). Parts that a
// keyframe does not show are taken from the next, and parts that none shows go on as in the first:
// with the farthest surface on the pixel's line, so never with what stands in front, or with what
// lies at the border. Colours are bilinear within a surface. web/display/shaders.js does the same.
#pragma once
#include <span>

#include "picture/keyframe.h"

namespace wellspring::picture {

// Holds the farthest and the nearest disparity of the new picture's blocks that a keyframe shows.
struct WarpBounds {
  std::vector<float> farthest, nearest;
};
// Holds memory that is kept from picture to picture, so that it is allocated once.
struct WarpScratch {
  std::vector<WarpBounds> bounds;  // bounds of each keyframe
};
size_t memory_bytes(const WarpScratch& scratch);

// Overwrites `out` with a picture of the size of `view`, and returns the share of its pixels that
// lie outside of all keyframes. If that is more than `most_unknown` (0 to 1) `out` may be left as
// it was. Keyframes stand in the order in which they are asked: the newest, the one before, a wide
// one of few pixels; empty ones count as none. Each passes into the next over some pixels at its
// border. Keyframes behind the first cost next to nothing if it shows all. Points behind either
// camera count as unknown; nothing but the keyframes is read, whatever the views are. The bits are
// the same whatever the number of threads.
float warp_picture(std::span<const Keyframe* const> keyframes, const View& view, float most_unknown,
                   WarpScratch& scratch, Image8& out);
// Warps one keyframe, or one and a wide one.
float warp_picture(const Keyframe& keyframe, const View& view, float most_unknown,
                   WarpScratch& scratch, Image8& out);
float warp_picture(const Keyframe& keyframe, const Keyframe& around, const View& view,
                   float most_unknown, WarpScratch& scratch, Image8& out);

}  // namespace wellspring::picture
