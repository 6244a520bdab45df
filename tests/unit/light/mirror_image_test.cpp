// SPDX-License-Identifier: Apache-2.0
// Images of mirrors and lenses lie where geometrical optics puts them.
#include "light/mirror_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/first_surface.h"
#include "light/technique.h"
#include "scenes/scenes.h"

using namespace wellspring;
using namespace wellspring::scenes;

namespace {

// A wall 3 m behind the eye, which is at the origin and looks along -Z.
Scene make_stage() {
  Scene scene = empty_scene();
  add_quad(scene, add_material(scene, diffuse(vec3(0.5f))), {20, -20, 3}, {-40, 0, 0}, {0, 40, 0},
           "wall");
  return scene;
}

Sample look(const Scene& scene, vec3 direction, vec3 eye = vec3(0)) {
  World world(scene);
  world.commit();
  Lights lights = make_lights(world);
  Request request;
  request.ray.origin = eye;
  request.ray.direction = normalize(direction);
  request.image = true;
  TransportSettings settings;
  return find_technique("path")->trace(world, lights, settings, request);
}

TEST(MirrorImage, OfAPlaneMirrorLiesAsFarBehindItAsThingsLieBefore) {
  Scene scene = make_stage();
  add_quad(scene, add_material(scene, metal(vec3(0.9f), 0)), {-5, -5, -2}, {10, 0, 0}, {0, 10, 0},
           "mirror");
  for (vec3 d : {vec3(0, 0, -1), vec3(0.3f, -0.2f, -1), vec3(-0.7f, 0.5f, -1)}) {
    Sample sample = look(scene, d);
    EXPECT_TRUE(sample.flags & sample_specular);
    EXPECT_NEAR(sample.image * normalize(d).z, -7, 0.02) << d.x;
    EXPECT_NEAR(sample.position.z, -2, 1e-4);
  }
}

TEST(MirrorImage, OfTwoPlaneMirrorsIsThatOfTheWholeWay) {
  Scene scene = empty_scene();
  int mirror = add_material(scene, metal(vec3(0.9f), 0));
  add_quad(scene, mirror, {-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, "far mirror");
  add_quad(scene, mirror, {8, -5, 1}, {-16, 0, 0}, {0, 10, 0}, "near mirror");
  add_quad(scene, add_material(scene, diffuse(vec3(0.5f))), {6, -5, -9}, {0, 10, 0}, {0, 0, 20},
           "side");
  Sample sample = look(scene, {1, 0, -1});  // 2 m to the mirror, 3 to the other, 1 to the side
  EXPECT_NEAR(sample.image, 6 * std::sqrt(2.0f), 0.02);
}

// 1/a + 1/b = -2/r of the mirror equation, near the axis.
TEST(MirrorImage, OfABallIsSmallAndJustBehindItsFront) {
  Scene scene = make_stage();
  add_mesh(scene, sphere_mesh(add_material(scene, metal(vec3(0.9f), 0)), 0.5f, 256), "ball",
           at({0, 0, -2}));
  Sample sample = look(scene, {0.004f, 0.003f, -1});  // the front is at 1.5, the wall 4.5 m from it
  EXPECT_NEAR(sample.image, 1.5f + 1 / (1 / 4.5f + 2 / 0.5f), 0.01);
}

TEST(MirrorImage, BehindASlabOfGlassIsDrawnNearer) {
  Scene scene = make_stage();
  add_quad(scene, add_material(scene, metal(vec3(0.9f), 0)), {-5, -5, -2}, {10, 0, 0}, {0, 10, 0},
           "mirror");
  add_mesh(scene, box_mesh(add_material(scene, glass(1.5f, 0, 0.3f)), {4, 4, 0.3f}), "slab",
           at({0, 0, 1}));
  EXPECT_NEAR(look(scene, {0.01f, 0.02f, -1}).image, 7 - 0.3f * (1 - 1 / 1.5f), 0.02);
}

TEST(MirrorImage, ThroughGlassThereIsNone) {
  Scene scene = empty_scene();
  add_mesh(scene, box_mesh(add_material(scene, glass(1.5f, 0, 0.3f)), {4, 4, 0.3f}), "slab",
           at({0, 0, -1}));
  add_quad(scene, add_material(scene, diffuse(vec3(0.5f))), {-20, -20, -3}, {40, 0, 0}, {0, 40, 0},
           "wall");
  Sample sample = look(scene, {0.01f, 0.02f, -1});
  EXPECT_TRUE(sample.flags & sample_specular);
  EXPECT_EQ(sample.image, 0);
}

TEST(MirrorImage, OfTheSkyIsFarAndOfMattThingsThereIsNone) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(1);
  add_quad(scene, add_material(scene, metal(vec3(0.9f), 0)), {-5, -5, -2}, {10, 0, 0}, {0, 10, 0},
           "mirror");
  EXPECT_GT(look(scene, {0.1f, 0, -1}).image, 500);
  EXPECT_EQ(look(make_stage(), {0, 0, 1}).image, 0);
}

// A hollow mirror of 2 m radius: what is 2.5 m before it is imaged, upside down, 1.67 m before it;
// what is at its middle, there.
TEST(MirrorImage, OfAHollowMirrorLiesBeforeItAndMayLieBehindTheEye) {
  auto image_of = [](float z) {
    Scene scene = empty_scene();
    add_mesh(scene, sphere_mesh(add_material(scene, metal(vec3(0.9f), 0)), 2, 256), "mirror");
    add_quad(scene, add_material(scene, diffuse(vec3(0.5f))), {-0.5f, -0.5f, z}, {0, 1, 0},
             {1, 0, 0}, "card");
    return look(scene, {0.004f, 0.003f, -1}, {0, 0, -0.2f}).image;
  };
  EXPECT_NEAR(image_of(0.5f), 1.8f - 1 / (1 - 1 / 2.5f), 0.01);
  EXPECT_EQ(image_of(0), 0);
}

}  // namespace
