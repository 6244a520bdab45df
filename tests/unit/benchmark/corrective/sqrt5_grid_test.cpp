// SPDX-License-Identifier: Apache-2.0
// Which pixels the levels of the sqrt(5) hierarchy hold, against a recursive construction.
#include "benchmark/corrective/sqrt5_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "unit/benchmark/corrective/stage.h"

namespace wellspring::test {
namespace {

using Pixel = std::pair<int, int>;

const PixelBox boxes[] = {{0, 0, 1, 1},        {3, 5, 4, 90},        {-13, -7, 40, 22},
                          {17, 3, 101, 54},    {0, 0, 64, 64},       {5, 60, 77, 61},
                          {-50, -41, -3, -11}, {511, 511, 512, 513}, {30000, 20001, 30037, 20013}};

std::vector<ivec2> all_places(const Sqrt5Grid& grid, int level, const PixelBox& box) {
  std::vector<ivec2> places;
  list_places(grid, level, box, 0, INT64_MAX, places);
  return places;
}

// The places of each level as Stamminger, Drettakis 2001 make them: each gives birth to four.
std::map<Pixel, int> grow(const Sqrt5Grid& grid, const PixelBox& box) {
  std::map<Pixel, int> found;
  ivec2 u = grid.step[0];
  int reach = 4 + 200 / std::max(1, int(std::hypot(u.x, u.y)));
  for (int j = -reach; j <= reach; j++)
    for (int i = -reach; i <= reach; i++) found[{i * u.x - j * u.y, i * u.y + j * u.x}] = 1;
  for (int level = 2; level <= grid.levels; level++) {
    ivec2 w = grid.step[size_t(level - 1)];
    std::map<Pixel, int> before = found;
    for (const auto& [p, old] : before)
      for (ivec2 way : {w, -w, ivec2(-w.y, w.x), ivec2(w.y, -w.x)})
        found.try_emplace({p.first + way.x, p.second + way.y}, level);
  }
  std::erase_if(found, [&](const auto& entry) {
    auto [x, y] = entry.first;
    return x < box.x0 || x >= box.x1 || y < box.y0 || y >= box.y1;
  });
  return found;
}

TEST(Sqrt5Grid, StepsFollowThePapersRecursionAndEndWithPixels) {
  const double turn = std::atan(0.5);
  for (int levels = 1; levels <= most_sqrt5_levels; levels++) {
    Sqrt5Grid grid = make_sqrt5_grid(levels);
    EXPECT_EQ(grid.step[size_t(levels - 1)], ivec2(1, 0));
    for (int level = 1; level < levels; level++) {
      ivec2 u = grid.step[size_t(level - 1)], next = grid.step[size_t(level)], v(-u.y, u.x);
      EXPECT_EQ(5 * next, 2 * u + v);
    }
    ivec2 first = grid.step[0];
    EXPECT_EQ(int64_t(first.x) * first.x + int64_t(first.y) * first.y,
              int64_t(std::llround(std::pow(5.0, levels - 1))));
    // The paper's s_l, with all grids turned by -(levels - 1) * atan(1/2).
    for (int level = 1; level <= levels; level++) {
      double angle = (level - levels) * turn, wide = std::pow(std::sqrt(5.0), levels - level);
      double side = wide * std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
      EXPECT_NEAR(footprint_side(grid, level), side, 1e-6 * side);
    }
  }
  EXPECT_EQ(make_sqrt5_grid(0).levels, 1);
  EXPECT_EQ(make_sqrt5_grid(99).levels, most_sqrt5_levels);
}

TEST(Sqrt5Grid, AllLevelsTogetherHoldEachPixelOnceAndOnlyOnce) {
  for (int levels = 1; levels <= 9; levels++)
    for (const PixelBox& box : boxes) {
      Sqrt5Grid grid = make_sqrt5_grid(levels);
      std::set<Pixel> seen;
      for (int level = 1; level <= levels; level++)
        for (ivec2 place : all_places(grid, level, box)) {
          EXPECT_TRUE(seen.insert({place.x, place.y}).second);
          EXPECT_EQ(level_of_pixel(grid, place), level);
          EXPECT_TRUE(place.x >= box.x0 && place.x < box.x1 && place.y >= box.y0 &&
                      place.y < box.y1);
        }
      EXPECT_EQ(seen.size(), size_t(box.x1 - box.x0) * size_t(box.y1 - box.y0));
    }
}

TEST(Sqrt5Grid, PlacesAreThoseOfTheRecursiveConstruction) {
  for (int levels = 1; levels <= 5; levels++)
    for (const PixelBox& box : {PixelBox{0, 0, 31, 17}, {-13, -7, 20, 9}, {-9, 3, -2, 25}}) {
      Sqrt5Grid grid = make_sqrt5_grid(levels);
      std::map<Pixel, int> expected = grow(grid, box), listed;
      for (int level = 1; level <= levels; level++)
        for (ivec2 place : all_places(grid, level, box)) listed[{place.x, place.y}] = level;
      EXPECT_EQ(listed, expected) << levels << " levels";
    }
}

TEST(Sqrt5Grid, AnyPositionOfALevelCanBeContinuedAt) {
  Sqrt5Grid grid = make_sqrt5_grid(4);
  for (const PixelBox& box : {boxes[2], boxes[3], boxes[1]})
    for (int level = 1; level <= 4; level++) {
      std::vector<ivec2> all = all_places(grid, level, box);
      EXPECT_EQ(Sqrt5Places(grid, level, box).count(), int64_t(all.size()));
      for (size_t from = 0; from <= all.size() + 1; from++) {
        std::vector<ivec2> some;
        list_places(grid, level, box, int64_t(from), 7, some);
        size_t begin = std::min(from, all.size()), end = std::min(from + 7, all.size());
        ASSERT_TRUE(std::equal(some.begin(), some.end(), all.begin() + ptrdiff_t(begin),
                               all.begin() + ptrdiff_t(end)));
        EXPECT_EQ(Sqrt5Places(grid, level, box, int64_t(from)).position(), int64_t(begin));
      }
    }
}

TEST(Sqrt5Grid, EmptyBoxesAndUnknownLevelsHaveNoPlaces) {
  Sqrt5Grid grid = make_sqrt5_grid(3);
  ivec2 place;
  EXPECT_FALSE(Sqrt5Places(grid, 1, {5, 5, 5, 9}).next(place));
  EXPECT_FALSE(Sqrt5Places(grid, 1, {5, 5, 2, 9}).next(place));
  EXPECT_FALSE(Sqrt5Places(grid, 0, {0, 0, 9, 9}).next(place));
  EXPECT_FALSE(Sqrt5Places(grid, 4, {0, 0, 9, 9}).next(place));
  EXPECT_FALSE(Sqrt5Places().next(place));
  EXPECT_EQ(Sqrt5Places(grid, 9, {0, 0, 9, 9}).count(), 0);
}

// Paints footprints of all places around a box, coarse to fine.
TEST(Sqrt5Grid, FinerFootprintsCoverNoPlaceOfACoarserLevel) {
  const int size = 70, margin = 400;
  for (int levels = 1; levels <= 8; levels++) {
    Sqrt5Grid grid = make_sqrt5_grid(levels);
    std::vector<int> painted(size * size, -1), times(size * size, 0);
    for (int level = 1; level <= levels; level++) {
      int side = footprint_side(grid, level), overlaps = 0;
      std::fill(times.begin(), times.end(), 0);
      for (ivec2 p : all_places(grid, level, {-margin, -margin, size + margin, size + margin}))
        for (int y = test::footprint_begin(p.y, side), yn = y + side; y < yn; y++)
          for (int x = test::footprint_begin(p.x, side), xn = x + side; x < xn; x++) {
            if (x < 0 || y < 0 || x >= size || y >= size) continue;
            bool own = x == p.x && y == p.y;
            // A pixel painted with its own number is a place of this or a coarser level.
            ASSERT_TRUE(own || painted[size_t(y * size + x)] != y * size + x);
            painted[size_t(y * size + x)] = own ? y * size + x : -2;
            overlaps += times[size_t(y * size + x)]++;
          }
      EXPECT_EQ(overlaps, 0) << "level " << level << " of " << levels;
    }
    for (int i = 0; i < size * size; i++) EXPECT_EQ(painted[size_t(i)], i);
  }
}

}  // namespace
}  // namespace wellspring::test
