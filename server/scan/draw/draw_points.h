// SPDX-License-Identifier: Apache-2.0
// Draws nodes of points as discs into planes of depth, colour and normal. Discs lie in the plane of
// their point's normal and are ellipses in the picture (Zwicker et al. 2001, "Surface splatting");
// they never become thinner than a pixel. Or points are spheres, with the depth and the normal of
// what each pixel sees of them (paper on large particle sets, section 5). Points are projected node
// by node, sorted into tiles, and each tile is drawn by itself in their order, so pictures are the
// same for any number of threads.
#pragma once
#include <memory>
#include <span>

#include "scan/draw/disc_style.h"
#include "scan/draw/point_buffer.h"
#include "scan/camera.h"
#include "scan/tree/node_points.h"

namespace wellspring::scan {

// Keeps its arrays from one picture to the next: about 40 bytes a point in sight.
class PointRaster {
 public:
  PointRaster();
  ~PointRaster();
  // Replaces `buffer` by the picture. Nodes are borrowed for the call, at most 2^20 pieces of 4096
  // points. Time is bounded by points and pixels: where discs would cover a tile many times over
  // they are drawn smaller, and spheres that nearer ones hide are not drawn.
  void draw(PointBuffer& buffer, std::span<const NodePoints> nodes, const ScanCamera& view,
            const DiscStyle& style);
  size_t memory_bytes() const;

 private:
  struct Arrays;
  std::unique_ptr<Arrays> arrays_;
};

}  // namespace wellspring::scan
