// SPDX-License-Identifier: Apache-2.0
// How much light comes to the places of a volume: of a lamp far away, through what lies between,
// and from all around. It is made once for a preset and a light, coarser than the volume, so that a
// ray that marches pays one look-up for soft shadows.
#pragma once
#include <vector>

#include "volume/draw/preset.h"
#include "volume/draw/shown_volume.h"

namespace wellspring::volume {

// Holds the light on a volume. Directions are in the frame of Volume::to_metres.
struct VolumeLight {
  vec3 to_lamp{0, 1, 0};  // unit
  vec3 lamp{1};           // irradiance on a surface that faces the lamp, over pi
  vec3 around{0.3f};      // radiance from all around
  bool operator==(const VolumeLight&) const = default;
};

struct LightGrid {
  glm::ivec3 size{0};
  glm::vec3 scale{1};  // places in the finest level times this are places in the grid
  // Shares of the lamp's light, and of the light around, that come there, as codes; x fastest.
  std::vector<uint8_t> lamp, around;
};

// Takes some 30 million steps of a ray for a volume of 256^3.
LightGrid make_light_grid(const ShownVolume& volume, const TransferTable& table,
                          const VolumeLight& light);

}  // namespace wellspring::volume
