// SPDX-License-Identifier: Apache-2.0
// What moves keeps light away from places near it.
#include "light/kept/moving_shade.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/sample/lights.h"
#include "scenes/build.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr vec3 up(0, 1, 0);

// A block of 1 m whose underside is half a metre above the floor's zero, and a lamp.
struct Room {
  Scene scene = empty_scene();
  std::unique_ptr<World> world;
  Lights lights;
  explicit Room(vec3 lamp = {3, 3, 0}) {
    scene.lights.push_back(point_light(lamp, vec3(20)));
    Mesh block = box_mesh(add_material(scene, diffuse(vec3(0.5f))), vec3(1));
    for (vec3& p : block.positions) p.y += 1;
    scene.objects.push_back("block");
    world = std::make_unique<World>(scene, std::vector<Mesh>{block}, std::vector<uint32_t>{1});
    lights = make_lights(*world);
  }
};

TEST(MovingShade, HidesAsMuchAsTheFormFactorSays) {
  const Room room;
  const MovingShade shade(*room.world);
  // A square that is as wide as twice its distance (Howell, factor B-4): four times 0.1385.
  EXPECT_NEAR(shade.eval_open(vec3(0), up, vec3(0)), 1 - 0.554f, 0.06f);
  EXPECT_EQ(shade.eval_open(vec3(0), -up, vec3(0)), 1) << "it is behind that surface";
  EXPECT_EQ(shade.eval_open({3, 0, 0}, up, vec3(0)), 1) << "it is far";
}

TEST(MovingShade, FadesWithoutSteps) {
  const Room room;
  const MovingShade shade(*room.world);
  float before = shade.eval_open(vec3(0), up, vec3(0));
  for (float x = 0.02f; x < 3; x += 0.02f) {
    const float now = shade.eval_open({x, 0, 0}, up, vec3(0));
    EXPECT_LT(std::abs(now - before), 0.05f) << x;
    before = now;
  }
}

TEST(MovingShade, LightFromTheOtherSideIsNotHidden) {
  const Room room;
  const MovingShade shade(*room.world);
  // Light that grows to the left, where the block is not, or to the right, where it is.
  const vec3 place(-1, 0, 0);
  EXPECT_GT(shade.eval_open(place, up, {-0.6f, 0, 0}),
            shade.eval_open(place, up, {0.6f, 0, 0}) + 0.05f);
}

TEST(MovingShade, TheShadowOfALampIsSharp) {
  Room room;
  const MovingShade shade(*room.world);
  const LightTables& tables = *room.lights.tables;
  StandInLit lit;
  lit.known = true;
  auto left_of = [&](vec3 place) {
    // The lamp's own light, and as much again from all around.
    const vec3 way = room.scene.lights[0].position - place;
    const float own = 20 * way.y / std::pow(length(way), 3.0f) / pi;
    lit.light = vec3(2 * own);
    return shade.shade(*room.world, tables, place, up, lit, 0, 0.1f, 0.02f).x / own;
  };
  // The line from the lamp to the first place passes the block, that to the second one does not.
  EXPECT_LT(left_of({-1, 0, 0}), 1.0f);
  EXPECT_GT(left_of({-1, 0, 1.2f}), 1.8f);
}

TEST(MovingShade, HiddenThingsShadeNothing) {
  Room room;
  room.world->show(0, false);
  room.world->commit();
  EXPECT_FALSE(MovingShade(*room.world).any());
}

}  // namespace
}  // namespace wellspring::test
