// SPDX-License-Identifier: Apache-2.0
// A scan is seen in a mirror, though the eye's own rays pass its stand-in.
#include <gtest/gtest.h>

#include "light/sample/lights.h"
#include "light/technique/technique.h"
#include "scenes/build.h"
#include "unit/light/statistics.h"
#include "unit/scan/made_nodes.h"
#include "world/load/stand_in.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// A scanned wall behind the eye, red to the left of the mirror's picture and green to the right of
// it, and a mirror before the eye. Its colours are its own light.
Scene make_room() {
  Scene scene = empty_scene();
  MadeNode node(8, 40);
  for (size_t i = 0; i < 1600; i++) node.color[i] = i % 40 < 20 ? 0xff0000ffu : 0xff00ff00u;
  node.points.color = node.color.data();
  Mesh mesh = make_stand_in(std::span(&node.points, 1));
  Material material = diffuse(vec3(1));
  material.double_sided = material.unlit = true;
  mesh.material = add_material(scene, material);
  // The grid lies down: it is put upright.
  add_mesh(scene, std::move(mesh), "scan",
           glm::translate(mat4(1), vec3(0, 0, 2)) * glm::rotate(mat4(1), 0.5f * pi, vec3(1, 0, 0)));
  add_wall(scene, metal(vec3(1), 0), -3);
  return scene;
}

TEST(ScanMirror, TheMirrorShowsItsColours) {
  const Scene scene = make_room();
  const World world(scene);
  const Lights lights = make_lights(world);
  for (const char* technique : {"path", "gather", "direct"}) {
    auto seen = [&](float x) {
      Request request{.ray = ray_towards(vec3(0), {x, 0.1f, -3}), .seed = 1};
      request.ray.from_eye = true;
      return find_technique(technique)->trace(world, lights, {}, request).radiance();
    };
    const vec3 left = seen(-0.5f), right = seen(0.5f);
    EXPECT_NEAR(left.x, 1, 0.02f) << technique;
    EXPECT_NEAR(left.y, 0, 0.02f) << technique;
    EXPECT_NEAR(right.x, 0, 0.02f) << technique;
    EXPECT_NEAR(right.y, 1, 0.02f) << technique;
  }
}

TEST(ScanMirror, TheEyeItselfSeesPointsNotTheStandIn) {
  const Scene scene = make_room();
  const World world(scene);
  Ray ray = ray_towards(vec3(0), {0.5f, 0.1f, 2});
  EXPECT_TRUE(world.intersect(ray).valid());
  ray.from_eye = true;
  EXPECT_FALSE(world.intersect(ray).valid());
}

}  // namespace
}  // namespace wellspring::test
