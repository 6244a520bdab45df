// SPDX-License-Identifier: Apache-2.0
// Exact shape under remembered light: what every pixel sees is drawn anew (light/see_picture.h),
// and the points only say how it is lit. Where no point of the right surface fell, reflectance is
// looked up and the light comes from the cells around, so that silhouettes and pictures on walls
// are sharp however few samples there are.
#pragma once
#include "cache/surface_image.h"
#include "light/see_picture.h"

namespace wellspring {

// The frame's planes hold a packed surface. Pixels that show another surface than the points say,
// or whose reflectance was guessed from neighbours, are overwritten.
// `resting`, null in motion: points of what does not move that were sampled from this very view are left
// alone, since they lie anywhere in their pixels and so antialias them. Others that show another surface
// are seen through gaps of a nearer one.
struct RestingPoints {
  const PointCache& points;
  const PointImage& image;  // of the view
};
void overlay_sight(const View& view, const PictureSight& sight, const RestingPoints* resting, Frame& frame);

}  // namespace wellspring
