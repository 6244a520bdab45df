// SPDX-License-Identifier: Apache-2.0
// Waits are bounded and long; nothing depends on how quick the machine is.
#include "show/state/baker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "light/kept/map_file.h"
#include "unit/folder.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

void wait(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }
template <class Condition>
bool wait_until(const Condition& holds) {
  for (int i = 0; i < 6000; i++) {
    if (holds()) return true;
    wait(0.01);
  }
  return false;
}

struct BakerTest : testing::Test {
  test::Folder folder;
  Scene scene = scenes::make_cornell_box();
  uint64_t key = hash_scene(scene);
  const World world{scene};
  BakerSettings settings{.file = folder.file("deep/box"),
                         .source = "content/box",
                         .places = {},
                         .least_error = 0.01,
                         .bake = {.gather_nodes = 300, .direct_nodes = 600},
                         .known = make_bake_scene(world, {}, {.nodes = 300}).known};
  bool is_idle(const Baker& baker) {  // for a while
    const uint64_t passes = baker.status().passes;
    for (int i = 0; i < 10; i++) {
      wait(0.02);
      if (baker.status().works || baker.status().passes != passes) return false;
    }
    return true;
  }
};

TEST_F(BakerTest, DoesNothingUnlessAllowed) {
  {
    settings.shown_error = 0.1f;
    Baker baker(scene, settings);
    EXPECT_TRUE(is_idle(baker));
    EXPECT_EQ(baker.status().passes, 0u);
    EXPECT_EQ(baker.status().error, 1);
    EXPECT_FALSE(baker.take());
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("deep/box.bake")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("deep/box.maps")));
}

TEST_F(BakerTest, GoesOnInWhatACoreHasToSpare) {
  settings.shown_error = 0.9f;
  Baker baker(scene, settings);
  baker.look({Ray{.origin = {0, 0.27f, 0.3f}, .direction = {0, 0, -1}}});
  baker.allow(BakerCores::spare);
  // It has lower priority than all else on the machine.
  bool found = false;
  for (int minute = 0; minute < 10 && !found; minute++)
    found = wait_until([&] { return baker.take() != nullptr; });
  EXPECT_TRUE(found);
}

TEST_F(BakerTest, HandsOverMapsAndKeepsThem) {
  std::shared_ptr<const IlluminationMap> map;
  settings.shown_error = 0.9f;
  {
    Baker baker(scene, settings);
    baker.allow(BakerCores::all);
    ASSERT_TRUE(wait_until([&] { return (map = baker.take()) != nullptr; }));
    EXPECT_LT(map->error, most_sure_error);
    EXPECT_GT(map->mean, 0.01f);
    EXPECT_GT(baker.status().passes, 0u);
    EXPECT_TRUE(wait_until([&] { return baker.status().error < 0.15f; }));
  }
  World world(scene);
  const LoadedMap kept = load_map(world, folder.file("deep/box.maps"), key);
  ASSERT_TRUE(kept.map);
  EXPECT_LE(kept.map->error, map->error);
  Bake bake;
  ASSERT_EQ(load_bake(world, folder.file("deep/box.bake"), key, bake), KeyedFile::read);
  EXPECT_GT(bake.passes, 0u);
  EXPECT_EQ(bake.source, "content/box");
}

TEST_F(BakerTest, StopsWhenItMayNotAndGoesOnWhenItMay) {
  settings.least_error = 0;
  Baker baker(scene, settings);
  baker.allow(BakerCores::all);
  ASSERT_TRUE(wait_until([&] { return baker.status().passes > 2; }));
  baker.allow(BakerCores::none);
  ASSERT_TRUE(wait_until([&] { return is_idle(baker); }));
  const uint64_t passes = baker.status().passes;
  EXPECT_TRUE(is_idle(baker));
  baker.allow(BakerCores::all);
  EXPECT_TRUE(wait_until([&] { return baker.status().passes > passes; }));
}

TEST_F(BakerTest, GoesOnWhereTheLastOneEnded) {
  uint64_t passes = 0;
  settings.least_error = 0;
  for (int time = 0; time < 2; time++) {
    Baker baker(scene, settings);
    baker.allow(BakerCores::all);
    EXPECT_TRUE(wait_until([&] { return baker.status().passes > passes; })) << time;
    passes = baker.status().passes;
  }
  // A map that is good enough already is left as it is.
  settings.least_error = 1e9;
  Baker baker(scene, settings);
  baker.allow(BakerCores::all);
  EXPECT_TRUE(wait_until([&] { return baker.status().passes >= passes; }));
  EXPECT_TRUE(is_idle(baker));
}

TEST_F(BakerTest, WhatIsDamagedOrOfAnotherSceneIsBakedAnew) {
  settings.shown_error = 0.9f;
  {
    Baker baker(scene, settings);
    baker.allow(BakerCores::all);
    ASSERT_TRUE(wait_until([&] { return baker.take() != nullptr; }));
  }
  scene.materials[1].base_color.x = 0.5f;
  const std::string broken = folder.read("deep/box.bake").substr(0, 1000);
  for (bool damaged : {false, true}) {
    if (damaged) folder.write("deep/box.bake", broken);
    std::shared_ptr<const IlluminationMap> map;
    {
      Baker baker(scene, settings);
      baker.allow(BakerCores::all);
      ASSERT_TRUE(wait_until([&] { return (map = baker.take()) != nullptr; })) << damaged;
    }
    EXPECT_EQ(find_map(folder.file("deep/box.maps"), hash_scene(scene)), KeyedFile::read);
    EXPECT_EQ(find_map(folder.file("deep/box.maps"), key), KeyedFile::another_key);
  }
}

TEST_F(BakerTest, WhereNothingIsDiffuseItRests) {
  scene = scenes::empty_scene();
  scenes::add_mesh(scene, scenes::box_mesh(0, vec3(1)), "metal");
  Baker baker(scene, settings);
  baker.allow(BakerCores::all);
  EXPECT_TRUE(is_idle(baker));
  EXPECT_TRUE(is_idle(baker));
  EXPECT_FALSE(baker.take());
}

}  // namespace
}  // namespace wellspring::test
