// SPDX-License-Identifier: Apache-2.0
// The choice among many lights: probabilities are those of the picks, add up to one, and never
// leave out a light that reaches the place.
#include "light/sample/light_tree.h"

#include "light/sample/lights.h"
#include "light/sample/sample_light.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

vec3 random_place(Rng& rng, float size) {
  return {size * (rng.uniform() - 0.5f), size * (rng.uniform() - 0.5f),
          size * (rng.uniform() - 0.5f)};
}

vec3 random_axis(Rng& rng) {
  vec3 v(0);
  while (!(dot(v, v) > 0.01f) || dot(v, v) > 1) v = random_place(rng, 2);
  return v / length(v);
}

// Small lights in a cube of 10 m: of every shape, cone and range.
std::vector<LightBounds> random_lights(int count, uint64_t seed, bool ranges = false) {
  Rng rng(seed);
  std::vector<LightBounds> lights;
  for (int i = 0; i < count; i++) {
    LightBounds b{.low = random_place(rng, 10)};
    b.high = b.low + 0.2f * vec3(rng.uniform(), rng.uniform(), rng.uniform());
    if (i % 3 == 0) b.high = b.low;
    b.axis = random_axis(rng);
    if (i % 3 == 1) b.cos_spread = -1;
    if (i % 5 == 2) b.cos_spread = 0.9f, b.cos_reach = 0.8f;
    b.two_sided = i % 4 == 3;
    b.strength = std::exp(4 * rng.uniform() - 2);
    if (ranges && i % 2) b.range = 1 + 3 * rng.uniform();
    lights.push_back(b);
  }
  return lights;
}

// Says whether a light certainly reaches a place: the least that a point of the light, straight or
// aslant, does.
bool reaches(const LightBounds& b, vec3 point, vec3 place, vec3 normal) {
  vec3 line = point - place;
  float distance = length(line);
  line /= distance;
  float cosine = -dot(b.axis, line);
  if (b.two_sided) cosine = std::abs(cosine);
  float spread = std::acos(glm::clamp(b.cos_spread, -1.0f, 1.0f));
  float angle = std::acos(glm::clamp(cosine, -1.0f, 1.0f)) - spread;
  bool in_cone = angle < std::acos(b.cos_reach) - 0.01f;
  return in_cone && distance < b.range && (normal == vec3(0) || dot(line, normal) > 0.01f);
}

TEST(LightTree, PicksAreAsProbableAsItSaysAndAddUpToOne) {
  for (int count : {1, 2, 8, 9, 104, 3000}) {
    LightTree tree = make_light_tree(random_lights(count, 5), LightChoice::by_place);
    ASSERT_FALSE(tree.empty());
    Rng rng(3);
    for (int place_number = 0; place_number < 3; place_number++) {
      vec3 place = random_place(rng, 30), normal(0);
      std::vector<double> counts(static_cast<size_t>(count)), expected(static_cast<size_t>(count));
      double sum = 0;
      constexpr int picks = 20000;
      for (int i = 0; i < count; i++) {
        double p = double(pick_light_probability(tree, place, normal, uint32_t(i)));
        sum += p;
        expected[size_t(i)] = p * picks;
      }
      // Cones that close over a whole branch lose what the branch was given; a tree of lights that
      // all reach the place loses nothing (the next test).
      EXPECT_LE(sum, 1 + 1e-4) << count;
      Mean left;
      int none = 0;
      for (int i = 0; i < picks; i++) {
        LightPick pick = pick_light(tree, place, normal, rng.uniform());
        if (!(pick.probability > 0)) {
          none++;
          continue;
        }
        ASSERT_NEAR(pick.probability, pick_light_probability(tree, place, normal, pick.index),
                    1e-5f * pick.probability);
        ASSERT_GE(pick.u, 0);
        ASSERT_LT(pick.u, 1);
        left.add(double(pick.u));
        counts[pick.index]++;
      }
      EXPECT_NEAR(none, (1 - sum) * picks, 5 * std::sqrt(picks * std::max(0.0, 1 - sum)) + 2);
      bool choice = *std::max_element(expected.begin(), expected.end()) < 0.99 * picks;
      if (choice && none < picks) expect_chi_squared(counts, expected, "light tree");
      if (none < picks) expect_mean(left, 0.5, "what is left of the number", 0.05);
    }
  }
}

TEST(LightTree, LightsThatAllReachAPlaceShareAllOfTheProbability) {
  for (int count : {2, 9, 104, 3000}) {
    std::vector<LightBounds> lights = random_lights(count, 8);
    for (LightBounds& b : lights) b.cos_spread = -1;  // emitting everywhere
    LightTree tree = make_light_tree(lights, LightChoice::by_place);
    Rng rng(4);
    for (vec3 place : {vec3(0), random_place(rng, 10), vec3(-1e6f, 3, 1), vec3(0, 40, 0)}) {
      double sum = 0;
      for (uint32_t i = 0; i < uint32_t(count); i++) {
        float p = pick_light_probability(tree, place, vec3(0), i);
        EXPECT_GT(p, 0);
        sum += double(p);
      }
      EXPECT_NEAR(sum, 1, 1e-4) << count;
    }
  }
}

TEST(LightTree, NoLightThatReachesAPlaceIsLeftOut) {
  std::vector<LightBounds> lights = random_lights(400, 11, true);
  LightTree tree = make_light_tree(lights, LightChoice::by_place);
  Rng rng(6);
  int reached = 0;
  for (int k = 0; k < 200; k++) {
    vec3 place = random_place(rng, 14), normal = k % 4 ? random_axis(rng) : vec3(0);
    for (uint32_t i = 0; i < lights.size(); i++) {
      vec3 size = lights[i].high - lights[i].low;
      vec3 point = lights[i].low + size * vec3(rng.uniform(), rng.uniform(), rng.uniform());
      if (!reaches(lights[i], point, place, normal)) continue;
      reached++;
      ASSERT_GT(pick_light_probability(tree, place, normal, i), 0) << "light " << i;
    }
  }
  EXPECT_GT(reached, 5000);
}

TEST(LightTree, NearAndFacingLightsArePreferred) {
  std::vector<LightBounds> lights;
  for (int i = 0; i < 100; i++) {
    LightBounds b;
    b.low = b.high = {float(i), 2, 0};
    b.axis = {0, i == 50 ? 1.0f : -1.0f, 0};  // the one in the middle emits light upwards
    b.strength = 1;
    lights.push_back(b);
  }
  LightTree tree = make_light_tree(lights, LightChoice::by_place);
  vec3 up(0, 1, 0);
  EXPECT_EQ(pick_light_probability(tree, {50, 0, 0}, up, 50), 0);
  EXPECT_GT(pick_light_probability(tree, {20, 0, 0}, up, 20), 0.1f);
  EXPECT_LT(pick_light_probability(tree, {20, 0, 0}, up, 90), 0.003f);
  for (uint32_t i = 0; i < 100; i++)  // all are behind
    EXPECT_EQ(pick_light_probability(tree, {50, 5, 0}, up, i), 0);
  EXPECT_EQ(pick_light(tree, {50, 5, 0}, up, 0.5f).probability, 0);
  // By strength alone all are alike.
  LightTree plain = make_light_tree(lights, LightChoice::by_strength);
  EXPECT_FLOAT_EQ(pick_light_probability(plain, {20, 0, 0}, up, 90), 0.01f);
}

TEST(LightTree, WhatCannotShineIsNeverPicked) {
  float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  std::vector<LightBounds> lights = random_lights(12, 2);
  lights[3].strength = 0;
  lights[4].strength = nan;
  lights[5].strength = infinity;
  lights[6].low.x = nan;
  lights[7].high.y = infinity;
  lights[8].strength = -2;
  LightTree tree = make_light_tree(lights, LightChoice::by_place);
  for (uint32_t i = 3; i <= 8; i++)
    EXPECT_EQ(pick_light_probability(tree, vec3(40, 0, 0), vec3(0), i), 0) << i;
  EXPECT_TRUE(make_light_tree({}, LightChoice::by_place).empty());
  EXPECT_TRUE(make_light_tree(std::span(&lights[3], 1), LightChoice::by_place).empty());
  EXPECT_TRUE(make_light_tree(std::span(&lights[3], 1), LightChoice::by_strength).empty());
}

// Ten thousand in one place, and a chain that halves its distances: neither deep recursion nor NaN.
TEST(LightTree, LightsInOnePlaceAndLightsInAChain) {
  std::vector<LightBounds> same(10000), chain(200);
  for (LightBounds& b : same) b.strength = 1, b.cos_spread = -1;
  for (size_t i = 0; i < chain.size(); i++) {
    chain[i].low = chain[i].high = vec3(std::ldexp(1.0f, int(i) - 100), 0, 0);
    chain[i].strength = 1;
    chain[i].cos_spread = -1;
  }
  for (const auto& lights : {same, chain}) {
    LightTree tree = make_light_tree(lights, LightChoice::by_place);
    for (vec3 place : {vec3(0), vec3(0, -1, 0), vec3(1e-20f, 0, 0)}) {
      double sum = 0;
      for (uint32_t i = 0; i < lights.size(); i++)
        sum += double(pick_light_probability(tree, place, vec3(0), i));
      EXPECT_NEAR(sum, 1, 1e-3);
    }
  }
}

// The whole tree in a scene: light from many lamps at a point is their sum, with most of them
// behind a wall or facing away. The tree does not know of the wall: it gains by nearness and facing
// alone, and that must be worth more than twice the samples.
TEST(LightTree, ManyLampsBehindAWallAreSampledWithoutBias) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  int lamp = add_material(scene, emitter(vec3(3)));
  for (int i = 0; i < 120; i++)
    add_quad(scene, lamp, {float(i % 12) - 6, 2.0f + 0.1f * float(i % 7), float(i / 12) - 5},
             {0.3f, 0, 0}, {0, 0, i % 3 ? 0.3f : -0.3f}, "lamp");
  add_quad(scene, diffuse(vec3(0)), {0.7f, 0, -9}, {0, 9, 0}, {0, 0, 18}, "wall");
  World world(scene);
  Lights tree = make_lights(world);
  ASSERT_GE(tree.tables->emitter_choice.nodes.size(), 240u / lane_count);
  auto plain = std::make_shared<LightTables>(*tree.tables);
  std::vector<float> power;
  for (const EmitterTriangle& e : plain->emitters) power.push_back(e.area);
  plain->emitter_choice = make_emitter_tree(plain->emitters, power, LightChoice::by_strength);
  TransportSettings settings{.max_depth = 2};
  Ray ray = ray_towards({0, 1, 3}, {0.2f, 0, 0.3f});
  Mean by_place, by_power;
  for (uint64_t seed = 1; seed <= 40; seed++) {
    by_place.add(trace_mean("path", world, tree, ray, 500, settings, seed).mean());
    by_power.add(
        trace_mean("path", world, {plain, tree.bad_samples}, ray, 1000, settings, 100 + seed)
            .mean());
  }
  expect_same_mean(by_place, by_power, "lamps behind a wall");
  EXPECT_LT(by_place.error(), 0.02 * by_place.mean());
  EXPECT_LT(by_place.error(), by_power.error()) << "half the samples do better";
}

}  // namespace
}  // namespace wellspring::test
