// SPDX-License-Identifier: Apache-2.0
// However a bake is divided, by threads, interruptions or shards: the same bits.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "unit/folder.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;
using test::Baked;

// The Cornell box with a ball and two lamps: of more tiles than a step takes.
Scene make_hall() {
  Scene scene = make_cornell_box();
  add_mesh(scene, sphere_mesh(1, 0.08f, 8), "ball", at({0.1f, 0.3f, -0.2f}));
  scene.lights.push_back(test::point_light({-0.1f, 0.3f, -0.1f}, {0.1f, 0.2f, 0.3f}));
  scene.lamps.push_back({"bulb", {0}, {}});
  return scene;
}
constexpr BakeSettings few{.gather_nodes = 6000, .direct_nodes = 7000};
constexpr uint64_t passes = 2;

Bake bake_at_once(const BakeSettings& settings = few) {
  Baked baked(make_hall(), settings);
  bake_passes(baked.lit, baked.bake, passes);
  return std::move(baked.bake);
}

TEST(BakeAgain, TheNumberOfThreadsChangesNoBit) {
  const Bake expected = bake_at_once();
  EXPECT_GT(expected.charts.tiles, 128u);
  for (size_t threads : {1, 5}) {
    using oneapi::tbb::global_control;
    global_control limit(global_control::max_allowed_parallelism, threads);
    const Bake other = bake_at_once();
    EXPECT_TRUE(same_bits(other, expected)) << threads;
    EXPECT_EQ(finish_map(other)->nodes.light, finish_map(expected)->nodes.light);
    EXPECT_EQ(bake_error(other), bake_error(expected));
  }
}

// Saved, and loaded by somebody who has nothing else, after each step.
TEST(BakeAgain, InterruptionsChangeNoBit) {
  const Bake expected = bake_at_once();
  test::Folder folder;
  const std::string file = folder.file("hall.bake");
  Baked baked(make_hall(), few);
  int steps = 0, within = 0;
  while (baked.bake.passes < passes) {
    go_on(baked.lit, baked.bake, [] { return true; });
    within += baked.bake.cursor > 0;
    if (steps++ % 3 != 0) continue;
    ASSERT_TRUE(save_bake(baked.bake, file, 7));
    Bake again;
    ASSERT_EQ(load_bake(baked.world, file, 7, again), KeyedFile::read);
    ASSERT_TRUE(same_bits(again, baked.bake));
    baked.bake = std::move(again);
  }
  EXPECT_GT(within, 3) << "not only between passes";
  EXPECT_TRUE(same_bits(baked.bake, expected));
  EXPECT_EQ(finish_map(baked.bake)->nodes.light, finish_map(expected)->nodes.light);
}

TEST(BakeAgain, AnotherSeedIsAnotherBake) {
  BakeSettings other = few;
  other.seed = 2;
  EXPECT_FALSE(same_bits(bake_at_once(other), bake_at_once()));
}

TEST(BakeAgain, ShardsAddUpToOneRun) {
  const Bake expected = bake_at_once();
  for (int shards : {2, 3}) {
    std::vector<Bake> parts;
    for (int shard = 0; shard < shards; shard++) {
      BakeSettings settings = few;
      settings.shard = shard, settings.shards = shards;
      parts.push_back(bake_at_once(settings));
      EXPECT_FALSE(same_bits(parts.back(), expected));
    }
    Bake whole = parts.back();
    EXPECT_FALSE(merge_bake(parts.back(), whole)) << "that one is there";
    for (int shard = 0; shard + 1 < shards; shard++)
      EXPECT_TRUE(merge_bake(parts[size_t(shard)], whole)) << shard;
    EXPECT_TRUE(same_bits(whole, expected)) << shards;
    EXPECT_EQ(whole.settings.shards, 1);
    EXPECT_EQ(finish_map(whole)->nodes.light, finish_map(expected)->nodes.light);
    // It goes on as one.
    Baked on(make_hall(), few), of_one(make_hall(), few);
    on.bake = whole, of_one.bake = expected;
    bake_passes(on.lit, on.bake, passes + 1);
    bake_passes(of_one.lit, of_one.bake, passes + 1);
    EXPECT_TRUE(same_bits(on.bake, of_one.bake)) << shards;
  }
}

TEST(BakeAgain, WhatIsNoOtherShardIsNotMerged) {
  BakeSettings first = few, second = few;
  first.shard = 0, second.shard = 1;
  first.shards = second.shards = 2;
  Bake whole = bake_at_once(first);
  const Bake before = whole, other = bake_at_once(second);
  Bake of_seed = other, of_three = other, one = other, early = other, finer = other;
  of_seed.settings.seed = 5;
  of_three.settings.shards = 3;
  one.settings.shards = 1;
  early.refined = 0;
  finer.direct = Baked(make_hall(), {.gather_nodes = 9000}).bake.direct;
  for (const Bake& part : {of_seed, of_three, one, early, finer, before})
    EXPECT_FALSE(merge_bake(part, whole));
  EXPECT_TRUE(same_bits(whole, before));
  EXPECT_TRUE(merge_bake(other, whole));
}

}  // namespace
}  // namespace wellspring::test
