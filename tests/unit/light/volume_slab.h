// SPDX-License-Identifier: Apache-2.0
// A volume whose effect on light is known by formula.
#pragma once
#include "unit/volume/draw_made.h"
#include "world/world.h"

namespace wellspring::test {

// A slab of 40 x 10 x 40 mm in even matter, `scale` times as large in the scene, through which
// exp(-thickness) of the light that falls straight down comes. `glow`: light that matter sends on.
inline PlacedVolume slab(double thickness, vec3 position, float scale, float glow = 0) {
  PlacedVolume placed;
  placed.volume = std::make_shared<const ShownVolume>(
      make_shown_volume(made_volume({40, 10, 40}, [](glm::vec3) { return 1.0f; })));
  const Preset preset{"even", VolumeMode::density, {{0.0, vec3(1, 0.7f, 0.4f), thickness / 10}}};
  const VolumeLight light{.lamp = vec3(0), .around = vec3(glow)};
  placed.look.preset = std::make_shared<const DrawnPreset>(*placed.volume, preset, light);
  placed.position = position, placed.scale = scale;
  placed.object = 3;
  return placed;
}

}  // namespace wellspring::test
