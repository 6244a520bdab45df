// SPDX-License-Identifier: Apache-2.0
// What is hard for pictures that are drawn in remembered light, while the visitor moves and at
// rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "judge/compare.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int width = 96, height = 54, pixels = width * height;

struct Visitor : DrawnVisit {
  void step(const Stage& stage, const View& view, int budget, bool rests = false) {
    DrawnVisit::step(stage, view, budget, rests ? PictureOf::still : PictureOf::moving);
  }
};

bool is_sound(const Frame& frame) {
  for (size_t i = 0; i < frame.color.size(); i++) {
    vec3 c = frame.color[i];
    if (!is_finite(c) || glm::min(glm::min(c.x, c.y), c.z) < 0 || !(frame.depth[i] > 0))
      return false;
  }
  return true;
}

View view_of(const Stage& stage, dvec3 eye, float yaw, float fov = 0.9f, int across = width,
             int down = height) {
  return make_view(stage.scene, eye, yaw, 0, fov, across, down);
}

// Compares the pictures as the eye sees them: no brighter than white.
double shown_error(Frame a, Frame b) {
  for (Frame* frame : {&a, &b})
    for (vec3& c : frame->color) c = glm::min(c, vec3(1));
  return rmse(a, b);
}

// A closed room of 4 x 3 x 4 m about (0, 1.5, 0) with a lamp, a pillar, and a thin screen.
Scene make_room() {
  Scene scene = empty_scene();
  add_room(scene, diffuse(vec3(0.6f, 0.55f, 0.5f)), vec3(4, 3, 4), "room", at(vec3(0, 1.5f, 0)));
  add_box(scene, diffuse(vec3(0.2f, 0.3f, 0.6f)), vec3(0.4f, 3, 0.4f), "pillar",
          at(vec3(1, 1.5f, -1)));
  add_box(scene, diffuse(vec3(0.6f, 0.2f, 0.1f)), vec3(2, 2, 0.02f), "screen",
          at(vec3(-0.6f, 1, -0.5f)));
  add_quad(scene, emitter(vec3(6)), {-0.5f, 2.99f, -0.5f}, {1, 0, 0}, {0, 0, 1}, "lamp");
  return scene;
}

// Towards the screen, through it and on through the wall behind: an eye upon a surface divides by
// nothing.
TEST(DrawnHardCases, ThroughASurfaceAndOut) {
  Stage stage(make_room());
  Visitor visitor;
  for (int i = 0; i <= 80; i++) {
    double z =
        i == 40 ? -0.49 : 0.5 - 0.0325 * i;  // the screen's face itself at 40, the far wall at 77
    View view = view_of(stage, {-0.4, 1.2, z}, 0);
    visitor.step(stage, view, pixels / 32);
    ASSERT_TRUE(is_sound(visitor.frame)) << i;
    if (i != 40) {
      ASSERT_LE(count_wrong(stage, view, visitor.frame), 2) << i;
    }
  }
  for (uint32_t object : visitor.frame.object) ASSERT_EQ(object, 0);  // outside there is nothing
  for (vec3 c : visitor.frame.color) ASSERT_EQ(c, vec3(0));
}

TEST(DrawnHardCases, AFullTurnInThreeTenthsOfASecond) {
  Stage stage(make_room());
  Visitor visitor;
  auto turned = [&](int i) { return view_of(stage, {0.3, 1.5, 1}, float(i) / 18 * 2 * float(pi)); };
  for (int i = 0; i < 30; i++) visitor.step(stage, turned(0), pixels / 16);
  Frame truth = stage.truth(turned(0), 64);
  double before = shown_error(visitor.frame, truth);
  for (int i = 1; i <= 18; i++) {
    visitor.step(stage, turned(i), pixels / 16);
    ASSERT_TRUE(is_sound(visitor.frame)) << i;
    ASSERT_LE(count_wrong(stage, turned(i), visitor.frame), 2) << i;
  }
  EXPECT_GT(visitor.cache.stats().reprojected, 0.1);  // not all is forgotten
  // Back where it began nothing is worse than if the visitor had stood.
  for (int i = 0; i < 10; i++) visitor.step(stage, turned(18), pixels / 16);
  EXPECT_LT(shown_error(visitor.frame, truth), 1.15 * before);
}

TEST(DrawnHardCases, FieldsOfView) {
  Stage stage(make_room());
  for (float degrees : {5.0f, 150.0f}) {
    Visitor visitor;
    View view = view_of(stage, {0.3, 1.5, 1}, 0.2f, degrees * float(pi) / 180);
    for (int i = 0; i < 20; i++) {
      visitor.step(stage, view, pixels / 8, i >= 10);
      ASSERT_TRUE(is_sound(visitor.frame)) << degrees << " " << i;
      if (i < 10) {
        ASSERT_LE(count_wrong(stage, view, visitor.frame), 2) << degrees;
      }
    }
    Frame truth = stage.truth(view, 64);
    EXPECT_LT(shown_error(visitor.frame, truth), degrees < 90 ? 0.012 : 0.035) << degrees;
  }
}

// The same room a thousand kilometres away, bit by bit the same pictures.
TEST(DrawnHardCases, FarFromTheOrigin) {
  auto pictures = [](dvec3 origin, Frame& moving, Frame& still) {
    Scene scene = make_room();
    scene.origin = origin;
    Stage stage(std::move(scene));
    Visitor visitor;
    for (int i = 0; i < 24; i++) {
      visitor.step(stage,
                   view_of(stage, origin + dvec3(0.25 + std::min(i, 12) / 32.0, 1.5, 1), 0.2f),
                   pixels / 8, i > 14);
      if (i == 12) moving = visitor.frame;
    }
    still = visitor.frame;
  };
  Frame near[2], far[2];
  pictures(dvec3(0), near[0], near[1]);
  pictures(dvec3(1e6, -2e6, 1e6), far[0], far[1]);
  for (int i = 0; i < 2; i++) {
    EXPECT_EQ(near[i].color, far[i].color);
    EXPECT_EQ(near[i].depth, far[i].depth);
  }
}

TEST(DrawnHardCases, AnotherSizeInTheMidstOfAWalk) {
  Stage stage(make_room());
  Visitor visitor;
  ivec2 sizes[] = {{96, 54}, {33, 71}, {1, 1}, {128, 2}, {160, 90}, {96, 54}};
  for (int i = 0; i < 36; i++) {
    ivec2 size = sizes[i / 6];
    View view = view_of(stage, {-0.6 + 0.03 * i, 1.5, 1}, 0, 0.9f, size.x, size.y);
    visitor.step(stage, view, size.x * size.y / 8 + 1, i % 6 == 5);
    ASSERT_EQ(visitor.frame.width, size.x);
    ASSERT_EQ(visitor.frame.height, size.y);
    ASSERT_TRUE(is_sound(visitor.frame)) << i;
    if (i % 6 != 5) {
      ASSERT_LE(count_wrong(stage, view, visitor.frame), 2) << i;
    }
  }
  View view = view_of(stage, {0.45, 1.5, 1}, 0);
  for (int i = 0; i < 20; i++) visitor.step(stage, view, pixels / 8, true);
  EXPECT_LT(shown_error(visitor.frame, stage.truth(view, 64)), 0.015);
}

TEST(DrawnHardCases, WithoutLightThereIsNone) {
  Scene scene = make_room();
  for (Material& m : scene.materials) m.emission = vec3(0);
  Stage stage(std::move(scene));
  Visitor visitor;
  View view = view_of(stage, {0.3, 1.5, 1}, 0);
  for (int i = 0; i < 12; i++) {
    visitor.step(stage, view, pixels / 8, i > 6);
    for (vec3 c : visitor.frame.color) ASSERT_EQ(c, vec3(0));
  }
  EXPECT_LE(count_wrong(stage, view, visitor.frame),
            pixels / 10);  // shapes are there, at other places of their pixels
}

// Two pictures in one plane: one of them is shown, and its light is that of the wall they hang
// before.
TEST(DrawnHardCases, CoplanarSurfaces) {
  Scene scene = make_room();
  int pale = add_material(scene, diffuse(vec3(0.6f, 0.55f, 0.5f)));
  add_quad(scene, pale, {0, 1, -1.9f}, {1.5f, 0, 0}, {0, 1, 0}, "one");
  add_quad(scene, pale, {0.5f, 1, -1.9f}, {1.5f, 0, 0}, {0, 1, 0}, "two");
  Stage stage(std::move(scene));
  Visitor visitor;
  for (int i = 0; i < 30; i++) {
    visitor.step(stage, view_of(stage, {-0.3 + 0.02 * i, 1.5, 1.2}, 0), pixels / 8);
    ASSERT_TRUE(is_sound(visitor.frame));
  }
  View view = view_of(stage, {-0.3 + 0.02 * 29, 1.5, 1.2}, 0);
  for (int i = 0; i < 30; i++) visitor.step(stage, view, pixels / 8, true);
  EXPECT_LT(shown_error(visitor.frame, stage.truth(view, 64)), 0.015);
}

// Triangles without a size, as long as needles, and of coordinates that are no normal numbers;
// lamps that give nothing.
TEST(DrawnHardCases, DegenerateThings) {
  Scene scene = make_room();
  const float tiny = std::numeric_limits<float>::denorm_min();
  int red = add_material(scene, diffuse(vec3(0.8f, 0.1f, 0.1f)));
  Mesh mesh{.positions = {{0, 1, 0},
                          {0, 1, 0},
                          {0, 1, 0},
                          {0, 1, -1},
                          {0, 2, -1},
                          {0, 1.5f, -1},
                          {tiny, 1, -1},
                          {0, 1 + tiny, -1},
                          {tiny, tiny, tiny},
                          {-1, 1.2f, -1},
                          {1, 1.2f, -1},
                          {1, 1.2f + 1e-6f, -1}}};
  mesh.normals.assign(mesh.positions.size(), vec3(0));
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};
  mesh.material = red;
  add_mesh(scene, mesh, "needles");
  add_quad(scene, emitter(vec3(tiny)), {-1, 0.5f, -1.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}, "dark lamp");
  add_quad(scene, emitter(vec3(5)), {-1, 0.5f, -1.6f}, {0, 0, 0}, {0, 0.5f, 0}, "no lamp");
  Stage stage(std::move(scene));
  Visitor visitor;
  for (int i = 0; i < 40; i++) {
    visitor.step(stage, view_of(stage, {0.01 * std::min(i, 20), 1.5, 1}, 0), pixels / 8, i >= 24);
    ASSERT_TRUE(is_sound(visitor.frame)) << i;
  }
  EXPECT_LT(shown_error(visitor.frame, stage.truth(view_of(stage, {0.2, 1.5, 1}, 0), 64)), 0.015);
}

// A grazing view along the floor.
TEST(DrawnHardCases, AlongTheFloor) {
  Stage stage(make_room());
  Visitor visitor;
  View view;
  for (int i = 0; i < 40; i++) {
    view = view_of(stage, {-0.3 + 0.01 * std::min(i, 20), 0.004, 1.5}, 0.3f);
    visitor.step(stage, view, pixels / 8, i >= 24);
    ASSERT_TRUE(is_sound(visitor.frame)) << i;
    if (i < 24) {
      ASSERT_LE(count_wrong(stage, view, visitor.frame), width / 4) << i;
    }
  }
  EXPECT_LT(shown_error(visitor.frame, stage.truth(view, 64)), 0.015);
}

// Within a solid of glass rays are cast. Through a ball of it, and at rest in its middle: its
// surface shows the room around, as the reference has it.
TEST(DrawnHardCases, AnEyeWithinGlass) {
  Scene scene = make_room();
  add_sphere(scene, glass(1.5f, 0, 1), 0.5f, "glass", at(vec3(-0.4f, 1.2f, 1)));
  Stage stage(std::move(scene));
  Visitor visitor;
  auto view = [&](int i) { return view_of(stage, {-0.4, 1.2, 1.8 - 0.04 * i}, 0.1f); };
  int inside = 0;
  for (int i = 0; i <= 40; i++) {
    inside += !stage.visibility->rasterises(view(i));
    visitor.step(stage, view(i), pixels / 16);
    ASSERT_TRUE(is_sound(visitor.frame)) << i;
    ASSERT_LE(count_wrong(stage, view(i), visitor.frame), pixels / 100) << i;
  }
  EXPECT_NEAR(inside, 25, 3);
  ASSERT_FALSE(stage.visibility->rasterises(view(20)));
  Frame truth = stage.truth(view(20), 256);
  for (int i = 0; i < 120; i++) visitor.step(stage, view(20), pixels / 2, true);
  EXPECT_LE(count_wrong(stage, view(20), visitor.frame), pixels / 100);
  EXPECT_LT(shown_error(visitor.frame, truth), 0.033);
}

// Things finer than their light's pixels are neither lost nor moved.
TEST(DrawnHardCases, ThinRailings) {
  Scene scene = make_room();
  int dark = add_material(scene, diffuse(vec3(0.05f)));
  for (int i = 0; i < 12; i++)
    add_mesh(scene, box_mesh(dark, vec3(0.02f, 1, 0.02f)), "rail",
             at(vec3(-1.5f + 0.25f * float(i), 1.5f, -0.2f)));
  Stage stage(std::move(scene));
  Visitor visitor;
  for (int i = 0; i < 30; i++) {
    View view = view_of(stage, {-0.3 + 0.02 * i, 1.5, 1.5}, 0);
    visitor.step(stage, view, pixels / 32);
    ASSERT_LE(count_wrong(stage, view, visitor.frame), 2) << i;
  }
}

}  // namespace
}  // namespace wellspring::test
