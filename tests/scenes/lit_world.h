// SPDX-License-Identifier: Apache-2.0
// A scene with all that rays ask of it, for tests.
#pragma once
#include <utility>
#include <vector>

#include "light/sample/lights.h"
#include "scenes/scenes.h"

namespace wellspring::scenes {

// Takes apart as well: auto [scene, world, lights] = LitWorld(make_cornell_box());
struct LitWorld {
  Scene scene;
  World world;  // it shows `scene` and meshes that move
  Lights lights;

  // Meshes that move show as the objects of these numbers.
  explicit LitWorld(Scene made, std::vector<Mesh> moving = {}, std::vector<uint32_t> objects = {})
      : scene(std::move(made)),
        world(scene, std::move(moving), std::move(objects)),
        lights(make_lights(world)) {}
};

}  // namespace wellspring::scenes
