// SPDX-License-Identifier: Apache-2.0
// Lamps out of a scene, and switched in a World.
#include "world/load/lamp.h"

#include <gtest/gtest.h>

#include "unit/world/load/asset.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

// Four squares in a row, at x = 0, 2, 4, 6: the first two are one mesh that emits light, the third
// another of the same material, the last emits light by being unlit. Lights by two names.
struct Row {
  Scene scene;
  Row() {
    scene.objects = {"", "bulb", "bulb far", "strip", "screen"};
    Material emitting{.name = "glow",
                      .base_color = vec4(0.2f, 0.2f, 0.2f, 1),
                      .metallic = 0,
                      .emission = vec3(3, 2, 1)};
    Material unlit{.name = "screen", .base_color = vec4(0.5f, 0.6f, 0.7f, 1), .unlit = true};
    Material dull{.name = "stone"};
    scene.materials = {emitting, unlit, dull};
    Mesh square{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    square.normals.assign(4, vec3(0, 0, 1));
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    Mesh screen = square;
    screen.material = 1;
    scene.meshes = {square, square, screen};
    auto at = [](float x) { return glm::translate(mat4(1), vec3(x, 0, 0)); };
    scene.instances = {{0, at(0), 1}, {0, at(2), 2}, {1, at(4), 3}, {2, at(6), 4}};
    PunctualLight light;
    for (const char* name : {"spot", "spot", "sun"}) {
      light.name = name;
      scene.lights.push_back(light);
    }
  }
};

vec3 shown(const World& world, int square) {
  Ray ray{.origin = {2 * float(square) + 0.6f, 0.3f, 5}, .direction = {0, 0, -1}};
  Hit hit = world.intersect(ray);
  if (!hit.valid()) return vec3(-1);
  const Material& material = world.material_of(hit.instance);
  Surface surface = eval_surface(world, ray, hit);
  return material.unlit ? surface.base_color : surface.emission;
}

TEST(Lamp, WhatIsSharedBecomesItsOwnAndLooksAsBefore) {
  Row row;
  World before(row.scene);
  vec3 light[4];
  for (int i = 0; i < 4; i++) light[i] = shown(before, i);
  EXPECT_TRUE(add_lamp({"far", {"bulb far"}, {}}, row.scene).empty());
  EXPECT_TRUE(add_lamp({"rest", {"spot"}, {"glow"}}, row.scene).size() ==
              1u);  // some of it is far's
  EXPECT_TRUE(add_lamp({"screen", {"screen", "sun"}, {}}, row.scene).empty());
  ASSERT_EQ(row.scene.lamps.size(), 3u);
  EXPECT_EQ(row.scene.lamps[1].lights, (std::vector<int>{0, 1}));
  EXPECT_EQ(row.scene.lamps[2].lights, (std::vector<int>{2}));
  EXPECT_EQ(row.scene.meshes.size(), 4u);     // one copy for the far bulb
  EXPECT_EQ(row.scene.materials.size(), 4u);  // likewise: the others keep theirs
  World world(row.scene);
  for (int i = 0; i < 4; i++) EXPECT_EQ(shown(world, i), light[i]) << i;
  for (int lamp = 0; lamp < 3; lamp++) {
    world.set_lamp(lamp, 0);
    EXPECT_EQ(world.lamp_levels()[size_t(lamp)], 0);
    for (int i = 0; i < 4; i++) {
      bool dark = lamp == 0 ? i == 1 : lamp == 1 ? i == 0 || i == 2 : i == 3;
      EXPECT_EQ(shown(world, i), dark ? vec3(0) : light[i]) << lamp << " " << i;
    }
    world.set_lamp(lamp, 100);
    for (int i = 0; i < 4; i++) {
      const bool dim = lamp == 0 ? i == 1 : lamp == 1 ? i == 0 || i == 2 : i == 3;
      EXPECT_LT(length(shown(world, i) - (dim ? brightness_of(100) : 1) * light[i]), 1e-5f)
          << lamp << " " << i;
    }
    world.set_lamp(lamp, lamp_full);
    for (int i = 0; i < 4; i++) EXPECT_EQ(shown(world, i), light[i]) << i;
  }
  EXPECT_THROW(world.set_lamp(3, lamp_full), std::out_of_range);
}

TEST(Lamp, WhatIsNoPartOfOneIsToldByName) {
  Row row;
  auto faults = add_lamp({"a", {"moon", "bulb", "sun"}, {"stone", "gold"}}, row.scene);
  ASSERT_EQ(faults.size(), 3u);
  EXPECT_TRUE(!faults[0].is_material && faults[0].index == 0);
  EXPECT_NE(faults[0].what.find("no node 'moon'"), std::string::npos) << faults[0].what;
  EXPECT_TRUE(faults[1].is_material && faults[1].index == 0);  // nothing is made of stone
  EXPECT_TRUE(faults[2].is_material && faults[2].index == 1);
  EXPECT_NE(faults[2].what.find("no material 'gold'"), std::string::npos) << faults[2].what;
  auto taken = add_lamp({"b", {"sun"}, {}}, row.scene);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_NE(taken[0].what.find("the lamp 'a'"), std::string::npos) << taken[0].what;
  row.scene.meshes[2].material = 2;
  auto dark = add_lamp({"c", {"screen"}, {"stone"}}, row.scene);
  ASSERT_EQ(dark.size(), 2u);
  for (const LampFault& fault : dark)
    EXPECT_NE(fault.what.find("shines"), std::string::npos) << fault.what;
}

// A chandelier is often an empty node with candles and lights below it.
TEST(Lamp, ANodeStandsForAllBelowIt) {
  Asset asset;
  int position = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  asset.root["materials"] = {{{"name", "wax"}, {"emissiveFactor", {1, 1, 1}}}};
  asset.root["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"material", 0}}}}}};
  asset.root["extensionsUsed"] = {"KHR_lights_punctual"};
  asset.root["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
  json light = {{"KHR_lights_punctual", {{"light", 0}}}};
  asset.root["nodes"] = {{{"name", "chandelier"}, {"children", {1, 2}}},
                         {{"name", "ring"}, {"children", {3}}},
                         {{"name", "glow"}, {"extensions", light}},
                         {{"name", "candle"}, {"mesh", 0}},
                         {{"name", "candle"}, {"mesh", 0}},
                         {{"name", "glow"}, {"extensions", light}}};
  asset.root["scenes"] = {{{"nodes", {0, 4, 5}}}};
  Scene scene = load(asset);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_TRUE(add_lamp({"chandelier", {"chandelier"}, {}}, scene).empty());
  EXPECT_EQ(scene.lamps[0].lights.size(), 1u);
  ASSERT_EQ(scene.lamps[0].materials.size(), 1u);
  size_t emitting = 0;
  for (const Instance& instance : scene.instances)
    emitting += scene.meshes[size_t(instance.mesh)].material == scene.lamps[0].materials[0];
  EXPECT_EQ(emitting, 1u);  // the other candle belongs to nobody
  auto rest = add_lamp({"rest", {"candle", "glow"}, {}}, scene);
  EXPECT_EQ(rest.size(), 2u);  // one of each name
  EXPECT_EQ(scene.lamps[1].lights.size(), 1u);
}

}  // namespace
}  // namespace wellspring::test
