// SPDX-License-Identifier: Apache-2.0
// The animations of a glTF file, and the meshes that they move, to a SceneMotion.
#pragma once
#include <vector>

#include "gltf/file.h"
#include "world/motion/scene_motion.h"

namespace wellspring::world {

class MotionLoad {
 public:
  // `nodes` at rest. Throws LoadError for animations that cannot be read.
  MotionLoad(File& file, const std::vector<Node>& nodes);

  struct Shown {
    int instance = 0;  // of Scene::instances
    size_t node = 0, mesh = 0, primitive = 0;
    int skin = -1;  // -1: it has none
    int tangent_uv = -1;
  };
  void note(const Shown& shown);
  // Adds the motion to the scene, if any clip moves anything that was noted.
  void finish(Scene& scene);

 private:
  Mover make_mover(const Shown& shown);
  File& file_;
  SceneMotion motion_;
  std::vector<Shown> shown_;
};

}  // namespace wellspring::world
