// SPDX-License-Identifier: Apache-2.0
// Points of a scan are lit by the map's light on the squares that stand in for them.
#include "light/kept/stand_in_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/light/kept/bake_cases.h"
#include "unit/scan/made_nodes.h"
#include "world/load/stand_in.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// A floor of 4 x 4 m in the light of one colour, brighter to the right.
struct LitFloor {
  Scene scene = empty_scene();
  std::unique_ptr<World> world;
  std::shared_ptr<const IlluminationMap> map;
  explicit LitFloor(vec3 at = vec3(0)) {
    const MadeNode node(4, 24);
    Mesh mesh = make_stand_in(std::span(&node.points, 1));
    Material material = diffuse(vec3(1));
    material.double_sided = true;
    mesh.material = add_material(scene, material);
    add_mesh(scene, std::move(mesh), "scan", scenes::at(at));
    world = std::make_unique<World>(scene);
    map = paint_map(*world, 0.1f, {[at](vec3 place) { return vec3(3 + place.x - at.x, 1, 0.5f); }});
  }
};

TEST(StandInLight, IsThatOfTheSquaresAround) {
  const LitFloor floor;
  const StandInLight light(*floor.world, 0, *floor.map);
  for (const float x : {-1.5f, -0.4f, 0.0f, 0.77f, 1.6f}) {
    const StandInLit lit = light.find({x, 0.01f, 0.3f}, {0, 1, 0});
    ASSERT_TRUE(lit.known);
    EXPECT_NEAR(lit.light.x, 3 + x, 0.05f) << x;
    EXPECT_NEAR(lit.light.y, 1, 0.02f);
    EXPECT_NEAR(lit.light.z, 0.5f, 0.02f);
  }
}

TEST(StandInLight, IsNotKnownWhereNothingIsNearOrFacesSo) {
  const LitFloor floor;
  const StandInLight light(*floor.world, 0, *floor.map);
  EXPECT_FALSE(light.find({0, 1, 0}, {0, 1, 0}).known);
  EXPECT_FALSE(light.find({0, 0, 0}, {1, 0, 0}).known);
  EXPECT_FALSE(light.find({1e30f, 0, 0}, {0, 1, 0}).known);
  EXPECT_FALSE(light.find(vec3(NAN), {0, 1, 0}).known);
}

TEST(StandInLight, EachSideHasItsOwn) {
  Scene scene = empty_scene();
  const MadeNode node(4, 24);
  Mesh mesh = make_stand_in(std::span(&node.points, 1));
  Material material = diffuse(vec3(1));
  material.double_sided = true;
  mesh.material = add_material(scene, material);
  add_mesh(scene, std::move(mesh), "scan");
  scene.lights.push_back(point_light({0, 3, 0}, vec3(20)));
  Baked baked(std::move(scene));
  const auto map = baked.map(6);
  const StandInLight light(baked.world, 0, *map);
  const StandInLit above = light.find({0, 0, 0}, {0, 1, 0}),
                   below = light.find({0, 0, 0}, {0, -1, 0});
  ASSERT_TRUE(above.known && below.known);
  // Irradiance over pi right below the lamp: 20 / 3^2 / pi.
  EXPECT_NEAR(above.light.x, 20 / 9.0f / pi, 0.1f);
  EXPECT_NEAR(below.light.x, 0, 0.01f) << "squares that lie across one another let light through";
  const StandInLit tilted = light.find({0, 0, 0}, glm::normalize(vec3(1, 1, 0)));
  EXPECT_NEAR(tilted.light.x, above.light.x * std::sqrt(0.5f), 0.15f * above.light.x)
      << "a map of normals is known by its slope";
}

TEST(StandInLight, IsTheSameFarFromTheOrigin) {
  const vec3 far(8000, -300, 12000);
  const LitFloor here, there(far);
  const StandInLight near_light(*here.world, 0, *here.map), far_light(*there.world, 0, *there.map);
  const vec3 place(0.4f, 0, 0.2f);
  EXPECT_NEAR(near_light.find(place, {0, 1, 0}).light.x,
              far_light.find(far + place, {0, 1, 0}).light.x, 0.05f);
}

}  // namespace
}  // namespace wellspring::test
