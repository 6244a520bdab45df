// SPDX-License-Identifier: Apache-2.0
// Lamps out of a scene's file: lights and what emits, named by those who furnish an exhibit.
#pragma once
#include <span>

#include "world/scene.h"

namespace wellspring::world {

struct LampNames {
  std::string name;
  // Lights, and things of which something emits light, by their nodes or by nodes above these; all
  // of a name.
  std::vector<std::string> nodes;
  std::vector<std::string> materials;  // all that is made of them, wherever it is
};

// A name that is no part of a lamp.
struct LampFault {
  bool is_material = false;
  size_t index = 0;  // of LampNames::nodes or materials
  std::string what;
};

// Adds a lamp of all that is named and is no fault to the scene. Materials and meshes that it
// shares with what is no part of it are copied, so that they are its own: the picture stays as it
// was.
std::vector<LampFault> add_lamp(const LampNames& names, Scene& scene);

// The punctual lights that a name means as LampNames::nodes has it. `fault`: why it means none.
std::vector<int> find_lights(const Scene& scene, const std::string& node, std::string& fault);
// The lamp that a light belongs to, or -1.
int lamp_of_light(const Scene& scene, int light);
// Takes these lights out of the scene and its lamps; the others move up.
void remove_lights(std::span<const int> lights, Scene& scene);

}  // namespace wellspring::world
