// SPDX-License-Identifier: Apache-2.0
// Scenes in glTF, with their pictures and animations.
#include <cmath>

#include "fuzz/fuzz.h"
#include "light/technique/technique.h"
#include "world/load/scene_join.h"
#include "world/load/scene_load.h"
#include "world/world.h"

namespace wellspring::fuzz {
namespace {

// A few pixels of what was accepted.
void draw(const Scene& scene) {
  const World world(scene);
  const Lights lights = make_lights(world);
  const View view = make_view_towards(scene, scene.origin + dvec3(0, 1, 3), scene.origin,
                                      vec3(0, 1, 0), 1.0f, 4, 3);
  const Frame frame = render_still(*find_technique("direct"), world, lights, view, {.spp = 1});
  for (vec3 color : frame.color)
    require(std::isfinite(color.x + color.y + color.z), "pictures are finite");
}

}  // namespace

void fuzz_gltf_scene(Bytes bytes) {
  const std::string file = write_file("fuzz.glb", bytes);
  load([&] { load_credit(file); });
  load([&] { list_scene_files(file); });
  load([&] { draw(load_scene(file, {.time = 0.5})); });
  load([&] { load_scene(file, {.motion = true}); });
}

}  // namespace wellspring::fuzz
