// SPDX-License-Identifier: Apache-2.0
// What the exhibit's animations move, in a World: a moving mesh each.
#pragma once
#include "show/exhibit/exhibit.h"
#include "world/world.h"

namespace wellspring::show {

// Where something may be while it moves, relative to the scene's origin.
struct Reach {
  vec3 centre{0};
  float radius = 0;  // metres; 0: nothing moves
};

struct Movers {
  std::vector<int> moving;     // of each of Exhibit::movers, which of the World's moving meshes
  std::vector<Reach> reach;    // of each of Exhibit::animations
  std::vector<double> posed;   // the times of these for which the world stands
  std::vector<char> mirrored;  // of each mover: its mesh was turned round when the world was made
  bool empty() const { return moving.empty(); }
};

// Appends their meshes, as they are when every animation begins, and the objects they belong to.
Movers make_movers(const Exhibit& exhibit, std::vector<Mesh>& moving,
                   std::vector<uint32_t>& moving_object);

// Moves them to where the animations have them at these times, seconds of each. True: something
// did; call World::commit() afterwards.
bool pose_movers(const Exhibit& exhibit, const std::vector<double>& times, Movers& movers,
                 World& world);

// The same as a mesh of exhibit.movers[mover].
Mesh mover_mesh(const Exhibit& exhibit, size_t mover, const std::vector<double>& times);

}  // namespace wellspring::show
