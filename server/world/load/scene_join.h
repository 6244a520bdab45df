// SPDX-License-Identifier: Apache-2.0
// Scenes of several files put side by side, and the light of one made stronger or weaker.
#pragma once
#include "world/scene.h"

namespace wellspring::world {

// Where a scene stands: scaled, then turned about +Y, then moved.
struct ScenePlace {
  dvec3 position{0};  // metres
  double yaw = 0;     // radians, positive turns left
  double scale = 1;   // above 0
  bool is_own() const { return position == dvec3(0) && yaw == 0 && scale == 1; }
};

// Moves all that is in the scene: meshes, lights, viewpoints. Candela grow with the square of the
// scale, so that what stands in their light is as bright as before. A scene whose lamps are named
// already is not for this.
void place_scene(Scene& scene, const ScenePlace& place);

// Adds all of `part`, nodes and names included; the environment stays that of `into`.
void join_scene(Scene& into, Scene part);

// Adds the materials of `part` with their textures and pictures; where the first of them is.
int add_materials(Scene& into, Scene& part);

// Multiplies punctual lights and what materials emit.
void scale_light(Scene& scene, float factor);

}  // namespace wellspring::world
