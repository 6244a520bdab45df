// SPDX-License-Identifier: Apache-2.0
#include "light/sample/shining.h"

#include <functional>

namespace wellspring::light {
namespace {

EmittingSources emitting(const Scene& scene, float others,
                         const std::function<float(size_t lamp)>& brightness) {
  EmittingSources emitting{std::vector<float>(scene.materials.size(), others),
                           std::vector<float>(scene.lights.size(), others), others > 0};
  for (size_t lamp = 0; lamp < scene.lamps.size(); lamp++) {
    for (int material : scene.lamps[lamp].materials)
      emitting.materials[size_t(material)] = brightness(lamp);
    for (int light : scene.lamps[lamp].lights) emitting.lights[size_t(light)] = brightness(lamp);
  }
  return emitting;
}

}  // namespace

EmittingSources find_emitting(const World& world) {
  const LampLevels& levels = world.lamp_levels();
  return emitting(world.scene(), 1, [&](size_t lamp) { return brightness_of(levels[lamp]); });
}

EmittingSources find_emitting_of(const Scene& scene, int lamp) {
  return emitting(scene, lamp < 0 ? 1 : 0,
                  [&](size_t other) { return int(other) == lamp ? 1.0f : 0.0f; });
}

}  // namespace wellspring::light
