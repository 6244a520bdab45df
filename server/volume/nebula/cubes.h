// SPDX-License-Identifier: Apache-2.0
// Turns the light of rings into cubic voxels behind a picture's pixels, and corrects them so that
// they show the picture again (Wenger and others, section 4.3, equation 3).
#pragma once
#include <glm/glm.hpp>

#include "image/image.h"
#include "volume/nebula/axis.h"
#include "volume/nebula/rings.h"
#include "volume/volume.h"

namespace wellspring::volume {

struct CubeSettings {
  bool correct = true;                // multiply each pixel's voxels by I_o / I_p
  SampleKind kind = SampleKind::f32;  // or u8 or u16, with a slope
  double width_metres = 1;            // the picture's longer side
};

struct CubeReport {
  int unreached_pixels = 0;  // have light, but no ring with light lies behind them: they stay dark
  double unreached_light = 0;  // their part of the picture's light
  // The largest difference between a picture's value and the sum of its voxels, in parts of the
  // brightest value, over pixels that are reached.
  double reprojection_error = 0;
};

// Fills a volume of 3 channels of linear light per voxel's depth. Voxel (x, y, z) lies behind pixel
// (x, y) of the picture, z runs away from the visitor, and the sum over z is the pixel's value. The
// axis's end that its angle points to leans to the visitor if the tilt is positive. The volume is
// as deep as the rings that have light. Whole numbers are rounded so that the error of a pixel's
// sum stays below half a step. Throws LoadError if the volume were larger than 2 GB.
Volume fill_cubes(const RingMap& map, const PictureAxis& axis, double tilt,
                  const image::LinearImage& picture, const CubeSettings& settings,
                  CubeReport& report);

// Returns what a visitor sees from the front, and beside it what one sees from the right: linear
// light, every value the sum of the voxels behind it. Takes volumes that fill_cubes() made.
image::LinearImage show_cubes(const Volume& volume);

}  // namespace wellspring::volume
