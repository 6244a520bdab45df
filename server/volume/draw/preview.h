// SPDX-License-Identifier: Apache-2.0
// Draws a volume by itself, as somebody sees it who stands before it.
#pragma once
#include <vector>

#include "volume/draw/march.h"

namespace wellspring::volume {

struct VolumePicture {
  int width = 0, height = 0;
  std::vector<vec3> color;   // linear light of the volume, rows from the top
  std::vector<float> clear;  // share of the light behind it that comes through
};

// Holds how a volume is looked at: from its front, turned around the upright axis.
struct PreviewView {
  int side = 480;     // pixels, both ways
  float turn = 0.5f;  // radians to the left
  float rise = 0.2f;  // radians from above
  float step = 0.7f;  // samples
  std::vector<VolumeCut> cuts;
};

// Holds where the eye stands, in the frame of Volume::to_metres.
struct PreviewEye {
  vec3 eye, from, right, above;  // `from`: from the volume's middle to the eye
  float half, pixel;             // the picture's and a pixel's, at a depth of 1
  int level;                     // whose samples are about as far apart as pixels

  PreviewEye(const ShownVolume& volume, const PreviewView& view);
  // Returns the unit direction through a place of the picture, in pixels.
  vec3 way(float x, float y) const;
};

VolumePicture draw_volume(const ShownVolume& volume, const DrawnPreset& preset,
                          const PreviewView& view);

// Returns the light in which presets are looked at: a lamp from the upper left, before the volume.
VolumeLight preview_light();

}  // namespace wellspring::volume
