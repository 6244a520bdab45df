// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 files (.gltf, .glb, embedded data) to a Scene. Every type, count, offset and index is
// checked before anything is read (gltf/file.h says what is refused and what is only warned of).
// Files a package names must lie inside the package's folder. Cost is linear in the file and
// bounded; may block on the disk; may be cancelled (base/worker.h).
#pragma once
#include <string>

#include "world/scene.h"

namespace wellspring::world {

struct SceneLoadOptions {
  // Seconds: the pose of the file's first animation at this time; 0 is the rest pose.
  double time = 0;
  // Folder that referenced files must stay inside; empty: the file's own folder.
  std::string package;
  // Keeps the file's animations and what they move: Scene::motions. The scene is at rest.
  bool motion = false;
};

// Throws LoadError naming file, JSON pointer and problem. What is only odd is told in
// Scene::warnings.
Scene load_scene(const std::string& path, const SceneLoadOptions& options = {});

// Latitude-longitude environment picture (.hdr) appended to the scene's images. Throws LoadError.
void load_environment(const std::string& path, Scene& scene);

}  // namespace wellspring::world
