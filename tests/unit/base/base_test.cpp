// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#include "base/load_error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/vec.h"
#include "base/worker.h"

namespace wellspring::test {
namespace {

TEST(Rng, StreamIsAFunctionOfItsSeedAlone) {
  Rng a(42), b(42), c(43);
  bool differs = false;
  for (int i = 0; i < 100; i++) {
    uint32_t value = a.next();
    EXPECT_EQ(value, b.next());
    differs |= value != c.next();
  }
  EXPECT_TRUE(differs);
}

TEST(Rng, UniformFillsItsIntervalEvenly) {
  Rng rng(7);
  int cells[64] = {};
  const int count = 64000;
  for (int i = 0; i < count; i++) {
    float u = rng.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    cells[int(u * 64)]++;
  }
  double chi_squared = 0;
  for (int cell : cells) chi_squared += (cell - 1000.0) * (cell - 1000.0) / 1000;
  EXPECT_LT(chi_squared, 103.4);  // 63 degrees of freedom, 0.1 %
}

TEST(Rng, NeighbouringSamplesHaveUnrelatedSeeds) {
  std::set<uint64_t> seeds;
  double sum = 0;
  for (uint32_t y = 0; y < 50; y++)
    for (uint32_t x = 0; x < 50; x++)
      for (uint32_t i = 0; i < 4; i++) {
        uint64_t seed = sample_seed(1, x, y, i);
        seeds.insert(seed);
        sum += Rng(seed).uniform();
      }
  EXPECT_EQ(seeds.size(), 10000u);
  EXPECT_NEAR(sum / 10000, 0.5, 4 * 0.2887 / 100);  // four standard errors
}

// A picture of the next seed is not this one, moved by a row.
TEST(Rng, NeighbouringSeedsShareNoSamples) {
  std::set<uint64_t> seeds;
  for (uint64_t seed = 0; seed < 4; seed++)
    for (uint32_t y = 0; y < 20; y++)
      for (uint32_t x = 0; x < 20; x++) seeds.insert(sample_seed(seed, x, y, 0));
  EXPECT_EQ(seeds.size(), 1600u);
}

TEST(Latest, NewestWinsAndDropsAreCounted) {
  Latest<int> box;
  EXPECT_FALSE(box.take());
  EXPECT_FALSE(box.put(1));
  EXPECT_TRUE(box.put(2));
  EXPECT_TRUE(box.full());
  EXPECT_EQ(box.take(), 2);
  EXPECT_FALSE(box.full());
  EXPECT_EQ(box.dropped(), 1u);
}

TEST(Latest, ReaderNeverSeesAnOlderValueAfterANewer) {
  Latest<int> box;
  std::thread writer([&] {
    for (int i = 1; i <= 20000; i++) box.put(i);
  });
  int last = 0;
  while (last < 20000)
    if (auto value = box.take()) {
      ASSERT_GT(*value, last);
      last = *value;
    }
  writer.join();
}

TEST(Parallel, EachIndexOnceAsAPiece) {
  std::vector<std::atomic<int>> visits(1000);
  parallel_each(int(visits.size()), [&](int i) { visits[size_t(i)]++; });
  for (const auto& v : visits) EXPECT_EQ(v, 1);
  parallel_each(0, [](int) { FAIL(); });
  parallel_each(-3, [](int) { FAIL(); });
}

// Items stay when a raw vector grows, and copies are equal; items with a value have it.
TEST(RawVector, KeepsWhatIsWritten) {
  RawVector<int> numbers(3);
  for (int i = 0; i < 3; i++) numbers[size_t(i)] = i;
  numbers.resize(5000);
  numbers.push_back(7);
  EXPECT_EQ(numbers.size(), 5001u);
  EXPECT_EQ(numbers.back(), 7);
  for (int i = 0; i < 3; i++) EXPECT_EQ(numbers[size_t(i)], i);
  numbers.assign(4, 9);
  RawVector<int> copy = numbers;
  EXPECT_EQ(copy, (RawVector<int>{9, 9, 9, 9}));
}

TEST(Parallel, EveryIndexOnce) {
  std::vector<int> visits(10007, 0);
  parallel_for(int(visits.size()), [&](int i) { visits[size_t(i)]++; });
  for (int count : visits) ASSERT_EQ(count, 1);
  parallel_ranges(0, 16, [](int, int) { FAIL(); });
}

TEST(LoadError, NamesFilePlaceAndProblem) {
  LoadError error("a.gltf", "/accessors/3", "reaches past its buffer");
  EXPECT_STREQ(error.what(), "a.gltf: /accessors/3: reaches past its buffer");
  EXPECT_STREQ(LoadError("a", "", "b").what(), "a: b");
}

}  // namespace
}  // namespace wellspring::test
