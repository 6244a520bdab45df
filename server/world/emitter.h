// SPDX-License-Identifier: Apache-2.0
// Light that is no surface: KHR_lights_punctual and the environment. Emissive surfaces are found by
// their material (light/sample/lights.h gathers them).
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::world {

enum class PunctualType : uint8_t { point, spot, directional };

// Photometric units are taken as radiometric one to one: 1 candela is 1 W/sr, 1 lux is 1 W/m^2 per
// channel.
struct PunctualLight {
  std::string name;
  PunctualType type = PunctualType::point;
  vec3 position{0};          // point, spot
  vec3 direction{0, 0, -1};  // the way the light travels: spot, directional; unit length
  vec3 intensity{1};         // point, spot: W/sr; directional: W/m^2 on a facing surface
  float range = std::numeric_limits<float>::infinity();
  float inner_cone = 0, outer_cone = pi / 4;  // radians from the axis
};

// What is switched together: a chandelier with all its candles, the spots of a show-case. Nothing
// belongs to two lamps. How one comes into a scene: world/load/lamp.h.
struct Lamp {
  std::string name;
  std::vector<int> lights;     // of Scene::lights
  std::vector<int> materials;  // of Scene::materials: what these emit; nothing else is made of them
};

// A disc at infinity, equally bright all over: the sun. No radiance: none.
struct SunDisc {
  vec3 direction{0, 1, 0};  // towards it, unit
  vec3 radiance{0};
  float angular_radius = 0;  // radians, at most pi / 2
};

// Light from infinity. No image: `radiance` from everywhere. With an image: latitude-longitude, +Y
// up, its middle column towards -Z, times `radiance`.
struct Environment {
  vec3 radiance{0};
  int image = -1;
  SunDisc sun{};  // on top of the rest
};

}  // namespace wellspring::world
