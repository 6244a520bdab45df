// SPDX-License-Identifier: Apache-2.0
// The scene whose baked light the targets of kept files read: a square under a lamp.
#pragma once
#include "unit/light/kept/bake_cases.h"

namespace wellspring::fuzz {

inline Scene make_lit_square() {
  using namespace scenes;
  Scene scene = empty_scene();
  test::add_fan(scene, add_material(scene, diffuse(vec3(0.5f))), {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  scene.lights.push_back(test::point_light({0.5f, 1, -0.5f}, vec3(1)));
  scene.lamps.push_back({"bulb", {0}, {}});
  return scene;
}
inline test::Baked& baked_square() {
  static test::Baked baked{make_lit_square(), {.gather_nodes = 9, .direct_nodes = 16}};
  return baked;
}

}  // namespace wellspring::fuzz
