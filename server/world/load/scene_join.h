// SPDX-License-Identifier: Apache-2.0
// Puts scenes of several files side by side, and makes the light of one stronger or weaker.
#pragma once
#include <string>
#include <vector>

#include "world/scene.h"

namespace wellspring::world {

// Holds the place of a scene: scaled, then turned about +Y, then moved.
struct ScenePlace {
  dvec3 position{0};  // metres
  double yaw = 0;     // radians, positive turns left
  double scale = 1;   // above 0
  bool is_own() const { return position == dvec3(0) && yaw == 0 && scale == 1; }
};

// Moves all that is in the scene: meshes, lights, viewpoints. Candela grow with the square of the
// scale, so that things in their light are as bright as before. Call it before lamps are named.
void place_scene(Scene& scene, const ScenePlace& place);

// Adds all of `part`, nodes and names included; the environment stays that of `into`.
void join_scene(Scene& into, Scene part);

// Adds the materials of `part` with their textures and pictures; returns the index of the first of
// them.
int add_materials(Scene& into, Scene& part);

// Multiplies punctual lights and the emission of materials.
void scale_light(Scene& scene, float factor);

// Lists the files of which a glTF file consists.

// Returns the files of buffers and pictures that lie beside a .gltf or .glb: paths relative to its
// folder, each once; not the file itself, nor missing ones. Throws LoadError.
std::vector<std::string> list_scene_files(const std::string& path);

// Reads who made a glTF file, as the file itself says: asset.copyright, and what model libraries
// write into asset.extras (title, author, license, source).

struct Credit {
  std::string file;  // name of the file, without its folder
  std::string title, author, licence, source, copyright;
  bool empty() const {
    return title.empty() && author.empty() && licence.empty() && source.empty() &&
           copyright.empty();
  }
};

// Reads a file's credit. Throws LoadError. `package` as in SceneLoadOptions.
Credit load_credit(const std::string& path, const std::string& package = "");

}  // namespace wellspring::world
