// SPDX-License-Identifier: Apache-2.0
// Eyes look through the backs of single-sided faces, by every technique, also behind a pane;
// mirrors show them.
#include <gtest/gtest.h>

#include "light/technique/technique.h"
#include "scenes/build.h"

namespace wellspring::test {
namespace {

using namespace scenes;

Material shining(vec3 color, bool double_sided) {
  Material m = diffuse(color);
  m.unlit = true;
  m.double_sided = double_sided;
  return m;
}

// A red wall that turns its back on an eye at (0, 0, 3) before a green one, both shining alike.
Scene red_before_green() {
  Scene scene = empty_scene();
  scene.cull_back_faces = true;
  const int red = add_material(scene, shining({1, 0, 0}, false));
  const int green = add_material(scene, shining({0, 1, 0}, false));
  add_quad(scene, red, {-1, -1, 0}, {0, 2, 0}, {2, 0, 0}, "red");
  add_wall(scene, green, -1, 1, "green");
  return scene;
}

vec3 look(const Technique& technique, const Scene& scene, dvec3 eye, dvec3 target) {
  const World world(scene);
  Lights lights = make_lights(world);
  const View view = make_view_towards(scene, eye, target, {0, 1, 0}, 0.1f, 8, 8);
  const Frame frame = render_still(technique, world, lights, view, {.spp = 4});
  vec3 sum(0);
  for (const vec3& color : frame.color) sum += color;
  return sum / float(frame.color.size());
}

TEST(BackFacesSeen, EveryTechniqueLooksThroughThem) {
  for (const Technique& technique : techniques()) {
    Scene scene = red_before_green();
    EXPECT_LT(glm::length(look(technique, scene, {0, 0, 3}, {0, 0, 0}) - vec3(0, 1, 0)), 0.01f)
        << technique.name;
    scene.cull_back_faces = false;
    EXPECT_LT(glm::length(look(technique, scene, {0, 0, 3}, {0, 0, 0}) - vec3(1, 0, 0)), 0.01f)
        << technique.name;
  }
}

TEST(BackFacesSeen, APaneBeforeThemChangesNothing) {
  for (const Technique& technique : techniques()) {
    Scene scene = red_before_green();
    const int pane = add_material(scene, glass(1.0f, 0, 0));
    add_wall(scene, pane, 1, 1, "pane");
    const vec3 seen = look(technique, scene, {0, 0, 3}, {0, 0, 0});
    EXPECT_GT(seen.y, 0.9f) << technique.name;
    EXPECT_LT(seen.x, 0.01f) << technique.name;
  }
}

TEST(BackFacesSeen, AMirrorShowsThem) {
  Scene scene = red_before_green();
  const int mirror = add_material(scene, metal(vec3(1), 0));
  add_quad(scene, mirror, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0},
           "mirror");  // faces the red wall's back
  const vec3 seen = look(*find_technique("path"), scene, {0, 0, 1.5}, {0, 0, 3});
  EXPECT_GT(seen.x, 0.9f);
  EXPECT_LT(seen.y, 0.01f);
}

}  // namespace
}  // namespace wellspring::test
