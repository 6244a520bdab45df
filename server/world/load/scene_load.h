// SPDX-License-Identifier: Apache-2.0
// Loads glTF 2.0 files (.gltf, .glb, embedded data) into a Scene. Every type, count, offset and
// index is checked before anything is read (gltf/file.h says what is refused and what is only
// warned of). Files a package names must lie inside the package's folder. Cost is linear in the
// file and bounded; may block on the disk; may be cancelled (base/worker.h).
#pragma once
#include <string>

#include "world/scene.h"

namespace wellspring::world {

struct SceneLoadOptions {
  // Seconds; the scene has the pose of the file's first animation at this time; 0 is the rest pose.
  double time = 0;
  // Folder that referenced files must stay inside; empty: the file's own folder.
  std::string package;
  // Keeps the file's animations and what they move: Scene::motions. The scene is at rest.
  bool motion = false;
};

// Loads a scene. Throws LoadError naming file, JSON pointer and problem. Merely odd things are
// listed in Scene::warnings.
Scene load_scene(const std::string& path, const SceneLoadOptions& options = {});

// Appends a latitude-longitude environment picture (.hdr) to the scene's images, and uses it.
// Throws LoadError.
void load_environment(const std::string& path, Scene& scene);

}  // namespace wellspring::world
