// SPDX-License-Identifier: Apache-2.0
#include "volume/bricks/brick_pool.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "base/load_error.h"
#include "bricks_made.h"

namespace wellspring::test {
namespace {

constexpr double long_after = 10;  // seconds: nobody looks at anything any more

// Looks a brick of the finest level up, and returns the level of what is found.
int level_of(const Bricked& bricked, glm::ivec3 brick) {
  return BrickReader(*bricked.shown.bricks).find(0, brick).level;
}

TEST(BrickPool, TheCoarsestBrickServesUntilFinerOnesHaveCome) {
  const Bricked bricked(volume_of(glm::ivec3(96), rough), 100);
  ASSERT_EQ(bricked.shown.levels.size(), 3u);
  EXPECT_EQ(bricked.shown.arrivals(), 0u);
  EXPECT_FALSE(bricked.pool->load_some()) << "nothing was looked for";
  EXPECT_EQ(level_of(bricked, {1, 2, 0}), 2);
  EXPECT_TRUE(bricked.pool->load_some());
  EXPECT_EQ(level_of(bricked, {1, 2, 0}), 0);
  EXPECT_EQ(bricked.shown.arrivals(), 2u) << "the brick, and the one around it";
  EXPECT_EQ(level_of(bricked, {0, 2, 0}), 1) << "the one around both";
  EXPECT_EQ(bricked.pool->stats().used, 3);
}

TEST(BrickPool, WhatIsFoundHasTheBricksSamples) {
  const Bricked bricked(volume_of(glm::ivec3(96), rough), 100);
  level_of(bricked, {2, 1, 0});
  bricked.load_all();
  const BrickReader reader(*bricked.shown.bricks);
  const FoundBrick found = reader.find(0, {2, 1, 0});
  ASSERT_EQ(found.level, 0);
  EXPECT_EQ(found.brick, glm::ivec3(2, 1, 0));
  std::vector<uint16_t> codes(stored_samples);
  const BrickFile& file = bricked.shown.bricks->file();
  file.read(file.entries[file.levels[0].number_of({2, 1, 0})], codes.data(), nullptr);
  EXPECT_TRUE(std::equal(codes.begin(), codes.end(), bricked.pool->codes() + found.place));
}

TEST(BrickPool, CoarserBricksAreLoadedFirst) {
  // 3 slots: one is the coarsest one's.
  const Bricked bricked(volume_of(glm::ivec3(96), rough), 3);
  level_of(bricked, {0, 0, 0}), level_of(bricked, {2, 2, 2});
  EXPECT_TRUE(bricked.pool->load_some());
  EXPECT_EQ(level_of(bricked, {0, 0, 0}), 1);
  EXPECT_EQ(level_of(bricked, {2, 2, 2}), 1);
}

TEST(BrickPool, WhatWasLookedAtLongestAgoMakesRoom) {
  Bricked bricked(volume_of({200, 20, 20}, rough), 6);
  const auto look = [&](int x) { return level_of(bricked, {x, 0, 0}); };
  look(0), bricked.load_all();  // and two around it
  ASSERT_EQ(bricked.pool->stats().used, 4);
  bricked.now += 4, look(1), bricked.load_all();
  bricked.now += 4, look(0);
  bricked.now += 4, look(3), bricked.load_all();
  EXPECT_EQ(bricked.pool->stats().used, 6);
  EXPECT_EQ(look(3), 0);
  EXPECT_EQ(look(0), 0);
  EXPECT_NE(look(1), 0) << "it made room";
  EXPECT_GT(bricked.pool->stats().dropped, 0u);
}

TEST(BrickPool, WhatSomebodyLooksAtIsNotDropped) {
  Bricked bricked(volume_of(glm::ivec3(96), rough), 5);
  for (int picture = 0; picture < 20; picture++) {
    bricked.now += 0.1;
    for (int i = 0; i < 27; i++) level_of(bricked, {i % 3, i / 3 % 3, i / 9});
    bricked.load_all();
  }
  EXPECT_EQ(bricked.shown.arrivals(), 4u) << "there is peace when all slots are in use";
  EXPECT_EQ(bricked.pool->stats().dropped, 0u);
}

TEST(BrickPool, WishesLapse) {
  Bricked bricked(volume_of(glm::ivec3(96), rough), 100);
  level_of(bricked, {1, 1, 1});
  bricked.now += long_after;
  EXPECT_FALSE(bricked.pool->load_some());
}

TEST(BrickPool, WhatAReaderHasFoundStaysWhileItLives) {
  Bricked bricked(volume_of(glm::ivec3(96), rough), 3);
  level_of(bricked, {0, 0, 0});
  bricked.load_all();
  auto reader = std::make_unique<BrickReader>(*bricked.shown.bricks);
  const FoundBrick found = reader->find(0, {0, 0, 0});
  ASSERT_EQ(found.level, 0);
  const uint16_t before = bricked.pool->codes()[found.place];
  bricked.now += long_after;
  std::atomic<bool> has_loaded = false;
  level_of(bricked, {2, 2, 2});
  std::thread loads([&] {
    bricked.pool->load_some();
    has_loaded = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(has_loaded);
  EXPECT_EQ(bricked.pool->codes()[found.place], before);
  reader.reset();
  loads.join();
  EXPECT_EQ(level_of(bricked, {2, 2, 2}), 0);
}

TEST(BrickPool, VolumesShareItAndLeaveNothing) {
  Bricked bricked(volume_of(glm::ivec3(96), rough), 40);
  const BrickPool& pool = *bricked.pool;
  {
    const ShownVolume other = open_shown_volume(bricked.file(), bricked.pool);
    BrickReader(*other.bricks).find(0, {0, 0, 0});
    bricked.load_all();
    EXPECT_EQ(other.arrivals(), 2u);
    EXPECT_EQ(bricked.shown.arrivals(), 0u);
    EXPECT_EQ(pool.stats().used, 4);
  }
  EXPECT_EQ(pool.stats().used, 1);
  // Two volumes have two bricks that stay, and there is one slot.
  Bricked small(volume_of(glm::ivec3(40), rough), 1);
  EXPECT_THROW(open_shown_volume(small.file(), small.pool), LoadError);
  EXPECT_EQ(level_of(small, {0, 0, 0}), 1);
}

TEST(BrickPool, ManyBricksOfOneCodeTakeOneSlot) {
  const Bricked bricked(shelled_ball(160), 100);
  EXPECT_EQ(bricked.pool->stats().used, 2);
  EXPECT_EQ(level_of(bricked, {0, 0, 0}), 0) << "it is there at once";
  EXPECT_EQ(level_of(bricked, {4, 4, 4}), 0);
  EXPECT_FALSE(bricked.pool->load_some());
}

TEST(BrickPool, AFileThatWasCutOffStaysCoarse) {
  const Bricked bricked(volume_of(glm::ivec3(96), rough), 100);
  std::filesystem::resize_file(bricked.file(), 5000);
  EXPECT_EQ(level_of(bricked, {0, 0, 0}), 2);
  bricked.load_all();
  EXPECT_EQ(level_of(bricked, {0, 0, 0}), 2);
  EXPECT_EQ(bricked.shown.arrivals(), 0u);
  EXPECT_EQ(bricked.pool->stats().failed, 2u);
  EXPECT_FALSE(bricked.pool->load_some()) << "it is not tried again";
}

TEST(BrickPool, AThreadLoadsWhatIsLookedFor) {
  const Bricked bricked(volume_of(glm::ivec3(96), rough), 100, 1);
  for (int i = 0; i < 27; i++)
    while (level_of(bricked, {i % 3, i / 3 % 3, i / 9}) > 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(bricked.shown.arrivals(), 27u + 8u);
}

}  // namespace
}  // namespace wellspring::test
