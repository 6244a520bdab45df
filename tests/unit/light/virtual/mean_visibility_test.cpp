// SPDX-License-Identifier: Apache-2.0
// Virtual lights whose light does not arrive where it is seen are left out, others are dimmed by
// what arrives.
#include "light/virtual/splat_visibility.h"

#include <gtest/gtest.h>

#include "light/sample/lights.h"
#include "light/virtual/splatter.h"
#include "scenes/scenes.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;

namespace {

// Two rooms of two metres with a wall between them, at x = 0, and a lamp in the left one.
struct Rooms {
  Scene scene = empty_scene();
  std::unique_ptr<World> world;
  Lights lights;
  SplatLights drawn;
  explicit Rooms(bool glass_wall = false) {
    const int white = add_material(scene, diffuse(vec3(0.7f)));
    add_mesh(scene, box_mesh(white, {4, 2, 2}, true), "rooms", at({0, 1, 0}));
    Material tinted = glass(1.5f, 0, 0);
    tinted.base_color = vec4(0.9f, 0.5f, 0.1f, 1);
    add_quad(scene, glass_wall ? add_material(scene, tinted) : white, {0, 0, 1}, {0, 0, -2},
             {0, 2, 0}, "wall");
    PunctualLight lamp;
    lamp.position = {-1, 1, 0};
    lamp.intensity = vec3(5);
    world = std::make_unique<World>(scene);
    lights = make_lights(*world);
    SplatSettings settings;
    settings.visibility = false;
    const std::vector<SplatSource> sources{make_splat_source(lamp, 1)};
    draw_virtual_lights({*world, *lights.tables}, sources, settings, {}, {}, drawn);
  }
  void dim(const std::vector<LitProbe>& probes, int rays = 16) {
    dim_hidden_lights({*world, *lights.tables}, probes, rays, drawn.lights);
  }
  double power(int channel = 0) const {
    double sum = 0;
    for (int i = 0; i < drawn.lights.count; i++)
      sum += double(drawn.lights.intensity(size_t(i))[channel]);
    return sum;
  }
};
const std::vector<LitProbe> left{{{-1, 0, 0.5f}, {0, 1, 0}}, {{-1.5f, 2, 0}, {0, -1, 0}}};
const std::vector<LitProbe> right{{{1, 0, 0.5f}, {0, 1, 0}}, {{1.5f, 2, 0}, {0, -1, 0}}};

TEST(MeanVisibility, LightOfTheSameRoomStays) {
  Rooms rooms;
  const double before = rooms.power();
  ASSERT_GT(rooms.drawn.lights.count, 100);
  rooms.dim(left);
  EXPECT_NEAR(rooms.power() / before, 1, 0.02);
  EXPECT_EQ(rooms.drawn.lights.padded() % lane_count, 0);
}

// But for what shines on no probe, which does not matter.
TEST(MeanVisibility, LightDoesNotPassWalls) {
  Rooms rooms;
  const vec3 before = sum_virtual_lights(rooms.drawn.lights, right[0].position, right[0].normal);
  ASSERT_GT(before.x, 0.01f);
  rooms.dim(right);
  for (const LitProbe& probe : right)
    EXPECT_EQ(sum_virtual_lights(rooms.drawn.lights, probe.position, probe.normal), vec3(0));
}

// Lights are dimmed by their mean visibility: over all places, some reached and others not, the sum
// of light is right.
TEST(MeanVisibility, IsRightInTheMean) {
  Rooms rooms;
  auto sum = [&](const std::vector<LitProbe>& probes) {
    double light = 0;
    for (const LitProbe& probe : probes)
      light += double(sum_virtual_lights(rooms.drawn.lights, probe.position, probe.normal).x);
    return light;
  };
  std::vector<LitProbe> both = left;
  both.insert(both.end(), right.begin(), right.end());
  const double reached = sum(left);
  rooms.dim(both, 32);
  EXPECT_NEAR(sum(both) / reached, 1, 0.1);
}

TEST(MeanVisibility, GlassTints) {
  Rooms rooms(true);
  auto tint = [&] {
    const vec3 light = sum_virtual_lights(rooms.drawn.lights, right[0].position, right[0].normal);
    return light.z / light.x;
  };
  const float before = tint();
  rooms.dim(right);
  EXPECT_LT(tint(), 0.5f * before);
  EXPECT_GT(tint(), 0);
}

// Nothing to ask, and nothing that is a number.
TEST(MeanVisibility, HardCasesChangeNothing) {
  Rooms rooms;
  const double before = rooms.power();
  rooms.dim({});
  rooms.dim(left, 0);
  rooms.dim({{{NAN, 0, 0}, {0, 1, 0}}});
  rooms.dim({{{1e30f, 0, 0}, {0, 0, 0}}});
  EXPECT_EQ(rooms.power(), before);
}

}  // namespace
