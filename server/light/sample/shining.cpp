// SPDX-License-Identifier: Apache-2.0
#include "light/sample/shining.h"

#include <functional>

namespace wellspring {
namespace {

EmittingSources emitting(const Scene& scene, char others,
                         const std::function<char(size_t lamp)>& is_on) {
  EmittingSources emitting{std::vector<char>(scene.materials.size(), others),
                           std::vector<char>(scene.lights.size(), others), bool(others)};
  for (size_t lamp = 0; lamp < scene.lamps.size(); lamp++) {
    for (int material : scene.lamps[lamp].materials)
      emitting.materials[size_t(material)] = is_on(lamp);
    for (int light : scene.lamps[lamp].lights) emitting.lights[size_t(light)] = is_on(lamp);
  }
  return emitting;
}

}  // namespace

EmittingSources find_emitting(const World& world) {
  return emitting(world.scene(), 1, [&](size_t lamp) { return char(world.is_on(int(lamp))); });
}

EmittingSources find_emitting_of(const Scene& scene, int lamp) {
  return emitting(scene, lamp < 0, [&](size_t other) { return char(int(other) == lamp); });
}

}  // namespace wellspring
