// SPDX-License-Identifier: Apache-2.0
// Light of lamps that are switched is that of a scene which never had the others.
#include "light/kept/lamps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/sample/light_tables.h"
#include "light/sample/illumination_map.h"
#include "light/technique/technique.h"
#include "scenes/scenes.h"
#include "unit/light/judge.h"
#include "world/load/lamp.h"

namespace wellspring::test {
namespace {

// The Cornell box with its lamp, a spot onto its floor, and light from outside.
Scene make_box(bool lamp, bool spot, bool rest) {
  Scene scene = scenes::make_cornell_box();
  if (rest) scene.environment.radiance = vec3(0.3f, 0.35f, 0.4f);
  if (!lamp)
    for (Material& material : scene.materials) material.emission = vec3(0);
  PunctualLight light;
  light.name = "spot";
  light.type = PunctualType::spot;
  light.position = {-0.2f, 0.5f, -0.1f};
  light.direction = normalize(vec3(0.3f, -1, -0.2f));
  light.inner_cone = 0.3f, light.outer_cone = 0.4f;
  light.intensity = {0.9f, 0.8f, 0.6f};
  if (spot) scene.lights.push_back(light);
  return scene;
}

struct Switched {
  Scene scene = make_box(true, true, true);
  std::unique_ptr<World> world;
  Lights all;
  Switched(const char* technique = nullptr) {
    EXPECT_TRUE(add_lamp({"lamp", {"lamp"}, {}}, scene).empty());
    EXPECT_TRUE(add_lamp({"spot", {"spot"}, {}}, scene).empty());
    world = std::make_unique<World>(scene);
    all = make_lights(*world);
    vec3 place(0, 0.27f, 0.3f);
    if (technique) find_technique(technique)->prepare(*world, std::span(&place, 1), all);
  }
  Lights light(bool lamp, bool spot) {
    world->set_lamp(0, lamp ? lamp_full : 0);
    world->set_lamp(1, spot ? lamp_full : 0);
    return relit(all, *world);
  }
};

test::Estimate mean_of(const Technique& technique, const World& world, const Lights& lights) {
  test::Effort effort;
  effort.replicates = 32, effort.spp = technique.begin_pass ? 8 : 32;
  View view = scenes::cornell_view(world.scene(), 16, 16);
  TransportSettings transport;
  transport.max_depth = 5;
  return test::estimate_prepared(technique, world, lights, view, transport, effort);
}

// Each is judged at a thousandth over all comparisons: |difference| below 4.2 standard errors, of
// eight.
void expect_same(const test::Estimate& a, const test::Estimate& b, const std::string& what) {
  double error = std::sqrt(a.error * a.error + b.error * b.error);
  EXPECT_LE(std::abs(a.mean - b.mean), 4.2 * error + 1e-6) << what;
  EXPECT_LT(error, 0.02 * b.mean + 1e-6) << what << ": too noisy to say";
}

TEST(SwitchedLamps, LightIsThatOfASceneWithoutThem) {
  Switched switched;
  for (const char* name : {"path", "instant_radiosity"})
    for (int states = 0; states < 4; states++) {
      bool lamp = states & 1, spot = states & 2;
      Scene other = make_box(lamp, spot, true);
      World world(other);
      expect_same(mean_of(*find_technique(name), *switched.world, switched.light(lamp, spot)),
                  mean_of(*find_technique(name), world, make_lights(world)),
                  std::string(name) + " " + std::to_string(states));
    }
}

// A dimmed lamp gives the same light as one that is so dark in the scene.
TEST(SwitchedLamps, DimmedLightIsThatOfASceneWithDarkerLamps) {
  Switched switched("gather");
  constexpr LampLevel lamp = 90, spot = 200;
  switched.world->set_lamp(0, lamp), switched.world->set_lamp(1, spot);
  const Lights dimmed = relit(switched.all, *switched.world);
  Scene other = make_box(true, true, true);
  for (Material& material : other.materials) material.emission *= brightness_of(lamp);
  other.lights[0].intensity *= brightness_of(spot);
  World world(other);
  Lights lights = make_lights(world);
  vec3 place(0, 0.27f, 0.3f);
  find_technique("gather")->prepare(world, std::span(&place, 1), lights);
  for (const char* name : {"path", "gather"})
    expect_same(mean_of(*find_technique(name), *switched.world, dimmed),
                mean_of(*find_technique(name), world, lights), name);
}

TEST(SwitchedLamps, FullLampsAreTheSceneBitForBit) {
  Switched switched("gather");
  for (int lamp : {0, 1}) switched.world->set_lamp(lamp, 100);
  for (int lamp : {0, 1}) switched.world->set_lamp(lamp, lamp_full);
  const Lights again = relit(switched.all, *switched.world);
  const LightTables &now = *again.tables, &all = *switched.all.tables;
  EXPECT_EQ(now.emitter_power, all.emitter_power);
  ASSERT_EQ(now.punctual.size(), all.punctual.size());
  EXPECT_EQ(now.punctual[0].intensity, all.punctual[0].intensity);
  for (size_t i = 0; i < all.emitters.size(); i++)
    EXPECT_EQ(now.emitters[i].emission, all.emitters[i].emission);
  for (size_t i = 0; i < switched.scene.instances.size(); i++) {
    const size_t material =
        size_t(switched.scene.meshes[size_t(switched.scene.instances[i].mesh)].material);
    EXPECT_EQ(switched.world->material_of(uint32_t(i)).emission,
              switched.scene.materials[material].emission);
  }
  const Switched other("gather");
  EXPECT_EQ(again.known->nodes.light, relit(other.all, *other.world).known->nodes.light);
}

TEST(SwitchedLamps, WithoutAnyOtherLightItIsDarkAndFinite) {
  Scene scene = make_box(true, true, false);
  add_lamp({"all", {"lamp", "spot"}, {}}, scene);
  World world(scene);
  Lights all = make_lights(world);
  world.set_lamp(0, 0);
  Lights dark = relit(all, world);
  for (const Technique& technique : techniques())
    EXPECT_EQ(mean_of(technique, world, dark).mean, 0) << technique.name;
  EXPECT_EQ(dark.bad_samples->load(), 0u);
  world.set_lamp(0, lamp_full);
  EXPECT_GT(mean_of(*find_technique("path"), world, relit(all, world)).mean, 0);
}

TEST(SwitchedLamps, KeptLightIsThatOfASceneWithoutThem) {
  Switched switched("gather");
  ASSERT_TRUE(switched.all.known);
  auto mean_of = [](const IlluminationMap& map) {
    double sum = 0;
    for (uint32_t light : map.nodes.light) sum += double(luminance(unpack_rgb9e5(light)));
    return sum / double(map.nodes.light.size());
  };
  vec3 place(0, 0.27f, 0.3f);
  for (int states = 0; states < 4; states++) {
    bool lamp = states & 1, spot = states & 2;
    Scene other = make_box(lamp, spot, true);
    World world(other);
    Lights lights = make_lights(world);
    find_technique("gather")->prepare(world, std::span(&place, 1), lights);
    // Nodes of both lie at the same places; each has few samples, all together many.
    EXPECT_NEAR(mean_of(*switched.light(lamp, spot).known) / mean_of(*lights.known), 1, 0.02)
        << states;
  }
}

TEST(SwitchedLamps, AChangeIsToldWhereItIs) {
  Switched switched("gather");
  const LampLevels both{lamp_full, lamp_full}, without_spot{lamp_full, 0}, none{0, 0};
  const auto cells =
      std::make_shared<LampCells>(make_lamp_cells(*switched.world, *switched.all.known));
  auto change_between = [&](const LampLevels& before, const LampLevels& after) {
    return LightChange(switched.scene, switched.all, cells, before, after);
  };
  LightChange nothing = change_between(both, both), spot = change_between(both, without_spot);
  LightChange back = change_between(without_spot, both), all = change_between(both, none);
  vec3 kept(1), added(0);
  vec3 lit(-0.11f, 0, -0.16f), floor(0, 1, 0), wall(-1, 0, 0);
  const Ray aside{.origin = {0, 0.5f, -0.5f}, .direction = {1, 0, 0}};
  const vec3 corner = aside.origin + switched.world->intersect(aside).t * aside.direction;
  EXPECT_FALSE(nothing.changes(lit, floor, kept, added));
  ASSERT_TRUE(spot.changes(lit, floor, kept, added));
  EXPECT_EQ(added, vec3(0));
  for (int c = 0; c < 3; c++) EXPECT_TRUE(kept[c] > 0.02f && kept[c] < 0.9f) << kept[c];
  vec3 left = kept;
  EXPECT_FALSE(spot.changes(corner, wall, kept, added));  // far from the spot's light
  kept = vec3(1), added = vec3(0);
  ASSERT_TRUE(back.changes(lit, floor, kept, added));
  EXPECT_EQ(kept, vec3(1));
  // The light that comes back is the light that went.
  for (int c = 0; c < 3; c++) EXPECT_GT(added[c], 0.2f);
  EXPECT_LT(left.x, 1);
  // Half of the light is half of what goes.
  const LampLevels half_spot{lamp_full, level_of(0.5f)};
  LightChange half = change_between(both, half_spot), on = change_between(half_spot, both);
  vec3 half_kept(1), half_added(0);
  ASSERT_TRUE(half.changes(lit, floor, half_kept, half_added));
  EXPECT_EQ(half_added, vec3(0));
  for (int c = 0; c < 3; c++) EXPECT_NEAR(1 - half_kept[c], 0.5f * (1 - left[c]), 0.01f);
  const vec3 whole = added;
  half_kept = vec3(1), half_added = vec3(0);
  ASSERT_TRUE(on.changes(lit, floor, half_kept, half_added));
  EXPECT_EQ(half_kept, vec3(1));
  for (int c = 0; c < 3; c++) EXPECT_NEAR(half_added[c], 0.5f * whole[c], 0.02f * whole[c]);
  kept = vec3(1);
  ASSERT_TRUE(all.changes(corner, wall, kept, added));
  EXPECT_LT(luminance(kept), 0.6f);
  // Without kept light every place counts as changed.
  Switched unprepared;
  LightChange unknown(unprepared.scene, unprepared.all, nullptr, both, none);
  kept = vec3(1), added = vec3(0);
  EXPECT_TRUE(unknown.changes(vec3(1e9f), floor, kept, added));
  EXPECT_EQ(kept, vec3(1));
  EXPECT_FALSE(all.changes(vec3(NAN), floor, kept, added));
}

}  // namespace
}  // namespace wellspring::test
