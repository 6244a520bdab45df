// SPDX-License-Identifier: Apache-2.0
// Scenes of several files put side by side, and the light of one made stronger or weaker.
#pragma once
#include <string>
#include <vector>

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

// The files that a glTF file consists of.

// Of buffers and pictures that lie beside a .gltf or .glb: paths relative to its folder, each once;
// not the file itself, and none of those that are missing. Throws LoadError.
std::vector<std::string> list_scene_files(const std::string& path);

// Who made a glTF file, as it says itself: asset.copyright, and what model libraries write into
// asset.extras (title, author, license, source).

struct Credit {
  std::string file;  // as the exhibit names it
  std::string title, author, licence, source, copyright;
  bool empty() const {
    return title.empty() && author.empty() && licence.empty() && source.empty() &&
           copyright.empty();
  }
};

// Throws LoadError. `package` as in SceneLoadOptions.
Credit load_credit(const std::string& path, const std::string& package = "");

}  // namespace wellspring::world
