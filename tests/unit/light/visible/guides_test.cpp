// SPDX-License-Identifier: Apache-2.0
// What reconstruction is told of each pixel without noise.
#include "light/visible/guides.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scenes.h"

namespace wellspring::test {
namespace {

using namespace scenes;

const vec3 red(0.8f, 0.1f, 0.2f), green(0.1f, 0.7f, 0.2f);

Guide guide_of(const Scene& scene, vec3 origin, vec3 direction) {
  World world(scene);
  Lights lights = make_lights(world);
  Ray ray{.origin = origin, .direction = normalize(direction)};
  Guide guide;
  eval_guides(world, lights, std::span(&ray, 1), std::span(&guide, 1));
  return guide;
}

void expect_near(vec3 is, vec3 wanted, float error) {
  for (int c = 0; c < 3; c++) EXPECT_NEAR(is[c], wanted[c], error) << "channel " << c;
}

// A wall at z = -3, seen from the origin.
Scene with_wall(const Material& material) {
  Scene scene = empty_scene();
  add_wall(scene, material, -3);
  return scene;
}

TEST(Guides, TellColourAndNormalOfWhatIsMatt) {
  Guide guide = guide_of(with_wall(diffuse(red)), {0, 0, 0}, {0.2f, 0.1f, -1});
  expect_near(guide.albedo, red, 0.05f);  // and a little gloss
  expect_near(guide.normal, {0, 0, 1}, 1e-3f);
}

TEST(Guides, TellColourOfBluntMetal) {
  Guide guide = guide_of(with_wall(metal(red, 0.6f)), {0, 0, 0}, {0, 0, -1});
  expect_near(guide.albedo, red, 0.02f);
}

TEST(Guides, FollowMirrorsToWhatTheyShow) {
  Scene scene = with_wall(metal(vec3(0.9f), 0));
  add_quad(scene, diffuse(green), {-9, -9, 5}, {0, 18, 0}, {18, 0, 0}, "behind");
  Guide guide = guide_of(scene, {0, 0, 0}, {0.1f, 0, -1});
  expect_near(guide.albedo, 0.9f * green, 0.05f);
  expect_near(guide.normal, {0, 0, -1}, 1e-3f);
}

TEST(Guides, LookThroughPanesAndSolidGlass) {
  for (float thickness : {0.0f, 1.0f}) {
    Scene scene = with_wall(diffuse(red));
    Material clear = glass(1.5f, 0, thickness);
    int material = add_material(scene, clear);
    if (thickness > 0) add_mesh(scene, box_mesh(material, {4, 4, 1}), "block", at({0, 0, -1.5f}));
    else add_wall(scene, material, -1, 4, "pane");
    Guide guide = guide_of(scene, {0, 0, 0}, {0.1f, 0.05f, -1});
    expect_near(guide.albedo, red, 0.12f);
    expect_near(guide.normal, {0, 0, 1}, 1e-2f);
  }
}

TEST(Guides, MirrorsThatFaceEachOtherEnd) {
  Scene scene = with_wall(metal(vec3(0.95f), 0));
  add_quad(scene, metal(vec3(0.95f), 0), {-9, -9, 3}, {0, 18, 0}, {18, 0, 0}, "other");
  Guide guide = guide_of(scene, {0, 0, 0}, {0, 0, -1});
  EXPECT_TRUE(is_finite(guide.albedo));
  EXPECT_GT(guide.albedo.x, 0.5f);
  EXPECT_LE(guide.albedo.x, 1);
}

TEST(Guides, LampsAndSkyCountWithTheirColourAtMostWhite) {
  Guide lamp = guide_of(with_wall(emitter({30, 0.5f, 0})), {0, 0, 0}, {0, 0, -1});
  EXPECT_FLOAT_EQ(lamp.albedo.x, 1);
  EXPECT_GE(lamp.albedo.y, 0.5f);
  Scene scene = empty_scene();
  scene.environment.radiance = {0.2f, 0.5f, 7};
  Guide sky = guide_of(scene, {0, 0, 0}, {0, 1, 0});
  expect_near(sky.albedo, {0.2f, 0.5f, 1}, 1e-5f);
  EXPECT_EQ(sky.normal, vec3(0));
}

TEST(Guides, OfAPictureAreAntialiased) {
  Scene scene = empty_scene();
  add_quad(scene, diffuse(red), {-9, -9, -3}, {9, 0, 0}, {0, 18, 0}, "left");
  add_quad(scene, diffuse(green), {0, -9, -3}, {9, 0, 0}, {0, 18, 0}, "right");
  World world(scene);
  Lights lights = make_lights(world);
  View view = make_view_towards(scene, {0, 0, 0}, {0, 0, -3}, {0, 1, 0}, 1.0f, 5, 3);
  GuidePlanes guides = make_guides(world, lights, view, 64);
  vec3 a = guides.albedo[5], middle = guides.albedo[7], b = guides.albedo[9];
  expect_near(a, red, 0.05f);
  expect_near(b, green, 0.05f);
  expect_near(middle, 0.5f * (a + b), 0.03f);
}

TEST(Guides, AreFiniteOnBadTriangles) {
  Scene scene = with_wall(diffuse(red));
  Mesh broken{.positions = {{-1, -1, -2}, {-1, -1, -2}, {1, 1, -2}, {NAN, 0, -2}}, .material = 0};
  broken.normals.assign(4, vec3(0, 0, 1));
  broken.triangles = {{0, 1, 2}, {0, 2, 3}};
  add_mesh(scene, broken, "broken");
  World world(scene);
  Lights lights = make_lights(world);
  View view = make_view_towards(scene, {0, 0, 0}, {0, 0, -3}, {0, 1, 0}, 1.0f, 33, 17);
  GuidePlanes guides = make_guides(world, lights, view, 2);
  for (size_t i = 0; i < guides.albedo.size(); i++) {
    ASSERT_TRUE(is_finite(guides.albedo[i]) && is_finite(guides.normal[i])) << i;
    ASSERT_LE(max_component(guides.albedo[i]), 1.0f);
  }
}

// A camera sees through show-cases in a row: no number of panes hides the colour behind them.
TEST(Guides, SeeThroughAnyNumberOfPanes) {
  for (float thickness : {0.0f, 0.01f}) {
    Scene scene = with_wall(diffuse(red));
    int clear = add_material(scene, glass(1.5f, 0, thickness));
    for (int i = 0; i < 12; i++) {
      vec3 middle(0, 0, -0.2f - 0.2f * float(i));
      if (thickness > 0) add_mesh(scene, box_mesh(clear, {4, 4, thickness}), "pane", at(middle));
      else add_quad(scene, clear, middle - vec3(2, 2, 0), {4, 0, 0}, {0, 4, 0}, "pane");
    }
    Guide guide = guide_of(scene, {0, 0, 0}, {0.02f, 0.01f, -1});
    EXPECT_NEAR(guide.albedo.y / guide.albedo.x, red.y / red.x, 0.01f) << thickness;
    EXPECT_GT(guide.albedo.x, 0.3f * red.x) << thickness;
    expect_near(guide.normal, {0, 0, 1}, 1e-3f);
  }
}

// A ray that total reflection keeps in a block of glass for ever has an end.
TEST(Guides, EndWhereGlassKeepsARay) {
  Scene scene = empty_scene();
  add_box(scene, glass(1.5f, 0, 1), vec3(1), "block");
  scene.environment.radiance = vec3(1);
  Guide guide = guide_of(scene, {0.1f, -0.07f, 0.03f}, {0.6f, 0.55f, -0.58f});
  EXPECT_EQ(guide.albedo, vec3(0));
  EXPECT_NEAR(glm::length(guide.normal), 1, 1e-4f);
}

}  // namespace
}  // namespace wellspring::test
