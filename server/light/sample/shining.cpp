// SPDX-License-Identifier: Apache-2.0
#include "light/sample/shining.h"

#include <functional>

namespace wellspring {
namespace {

Shining shining(const Scene& scene, char others, const std::function<char(size_t lamp)>& is_on) {
  Shining shining{std::vector<char>(scene.materials.size(), others),
                  std::vector<char>(scene.lights.size(), others), bool(others)};
  for (size_t lamp = 0; lamp < scene.lamps.size(); lamp++) {
    for (int material : scene.lamps[lamp].materials)
      shining.materials[size_t(material)] = is_on(lamp);
    for (int light : scene.lamps[lamp].lights) shining.lights[size_t(light)] = is_on(lamp);
  }
  return shining;
}

}  // namespace

Shining what_shines(const World& world) {
  return shining(world.scene(), 1, [&](size_t lamp) { return char(world.is_on(int(lamp))); });
}

Shining what_shines_of(const Scene& scene, int lamp) {
  return shining(scene, lamp < 0, [&](size_t other) { return char(int(other) == lamp); });
}

}  // namespace wellspring
