// SPDX-License-Identifier: Apache-2.0
// Makes lamps out of a scene's file: lights and emitting things, named by the people who furnish an
// exhibit.
#pragma once
#include <span>

#include "world/scene.h"
#include "world/world.h"

namespace wellspring::world {

struct LampNames {
  std::string name;
  // Names of lights, and of things of which a part emits light, or of nodes above these; all nodes
  // of a name.
  std::vector<std::string> nodes;
  std::vector<std::string> materials;  // everything that is made of these, wherever it is
};

// Reports a name that cannot be part of a lamp.
struct LampFault {
  bool is_material = false;
  size_t index = 0;  // index into LampNames::nodes or materials
  std::string what;
};

// Adds a lamp of all names without a fault to the scene. Materials and meshes that the lamp shares
// with other things are copied, so that it has its own: the picture stays as it was.
std::vector<LampFault> add_lamp(const LampNames& names, Scene& scene);

// Returns the punctual lights of a name, as in LampNames::nodes. `fault`: the reason if there are
// none.
std::vector<int> find_lights(const Scene& scene, const std::string& node, std::string& fault);
// Returns the lamp to which a light belongs, or -1.
int lamp_of_light(const Scene& scene, int light);
// Finds how a lamp is switched by a word: "on", "off" or a light of its dial. None: it has no such
// state; `states` lists those that it has.
std::optional<LampSwitch> find_switch(const Scene& scene, const Lamp& lamp, const std::string& word,
                                      std::string& states);
// Takes these lights out of the scene and its lamps; the others move up.
void remove_lights(std::span<const int> lights, Scene& scene);

}  // namespace wellspring::world
