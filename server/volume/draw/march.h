// SPDX-License-Identifier: Apache-2.0
// Marches through a volume along eight rays at a time, front to back: emission and absorption
// (Max 1995, "Optical Models for Direct Volume Rendering", section 4), the first surface of a
// value, or the largest value. Cells in which nothing is seen are leapt over, and rays end where
// nothing behind can be seen.
#pragma once
#include <span>
#include <vector>

#include "volume/draw/along_ray.h"
#include "volume/draw/light_grid.h"
#include "volume/draw/preset.h"
#include "volume/draw/shown_volume.h"

namespace wellspring::volume {

// Holds what is needed to draw a preset of a volume in some light.
struct DrawnPreset {
  TransferTable table;
  VolumeLight light;
  LightGrid grid;
  std::vector<std::vector<uint8_t>> seen;  // for each level and cell: whether anything is seen

  DrawnPreset(const ShownVolume& volume, const Preset& preset, const VolumeLight& light);
};

// Eight rays in the frame of Volume::to_metres: unit directions; metres from which, and to which,
// they are followed. A ray is not followed where `far` is not beyond `near`.
struct VolumeRays {
  Lanes3 origin, direction;
  Lanes near{}, far{};
};

struct MarchSettings {
  int level = 0;
  float step = 0.7f;                                             // samples of the level
  Lanes jitter{0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};  // share of a step, 0 to 1
  std::span<const VolumeCut> cuts;
};

struct MarchedLight {
  Lanes3 color;       // linear light that the volume sends to the eye
  Lanes clear{};      // share of the light behind it that comes through
  Lanes depth{};      // metres along the ray until half is absorbed; infinity: less is
  int64_t steps = 0;  // samples that were read, of all lanes
};

MarchedLight march(const ShownVolume& volume, const DrawnPreset& preset, const VolumeRays& rays,
                   const MarchSettings& settings);

// Returns the level whose samples are at least as far apart as pixels are: `footprint` is the
// metres from pixel to pixel at the volume.
int level_for(const ShownVolume& volume, double footprint);

}  // namespace wellspring::volume
