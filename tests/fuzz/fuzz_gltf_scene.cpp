// SPDX-License-Identifier: Apache-2.0
// Scenes in glTF, with their pictures and animations.
#include "fuzz/fuzz.h"
#include "world/load/credit.h"
#include "world/load/scene_files.h"
#include "world/load/scene_load.h"

namespace wellspring::fuzz {

void fuzz_gltf_scene(Bytes bytes) {
  const std::string file = write_file("fuzz.glb", bytes);
  load([&] { load_credit(file); });
  load([&] { list_scene_files(file); });
  load([&] { load_scene(file, {.time = 0.5}); });
  load([&] { load_scene(file, {.motion = true}); });
}

}  // namespace wellspring::fuzz
