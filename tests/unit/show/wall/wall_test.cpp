// SPDX-License-Identifier: Apache-2.0
// Tiles of a wall against the wide picture that they are parts of.
#include "show/wall/wall.h"

#include <gtest/gtest.h>

#include <cmath>

#include "picture/keyframe.h"
#include "unit/show/tiny_exhibit.h"
#include "world/world.h"

namespace wellspring::test {
namespace {

WallPart wall_of(int columns, int rows, vec2 bezel = vec2(0)) {
  WallPart wall;
  wall.name = "hall";
  wall.columns = columns, wall.rows = rows, wall.bezel = bezel;
  return wall;
}

View wide_view(const Scene& scene, const WallSize& whole) {
  return make_view(scene, dvec3(-2, 1.6, 3), 0.2f, 0.1f, 0.9f, whole.width, whole.height);
}

View tile_view(const View& wide, const WallPart& wall, int column, int row) {
  return window_view(wide, tile_window(wall, {wide.width, wide.height}, column, row));
}

// A ray's direction, scaled to a depth of 1: the place in the window that all tiles share.
vec3 at_depth_1(const View& view, float x, float y) {
  const vec3 d = view_ray(view, x, y).direction;
  return d / dot(d, view.forward);
}

TEST(Wall, CornersOfNeighboursMeetWithoutFrames) {
  const WallPart wall = wall_of(3, 2);
  const WallSize tile{64, 40}, whole = wall_size(wall, tile);
  EXPECT_EQ(whole, (WallSize{192, 80}));
  const View wide = wide_view(Scene(), whole);
  for (int row = 0; row < 2; row++)
    for (int column = 0; column < 2; column++) {
      const View left = tile_view(wide, wall, column, row),
                 right = tile_view(wide, wall, column + 1, row);
      EXPECT_EQ(left.width, tile.width);
      EXPECT_EQ(left.height, tile.height);
      EXPECT_EQ(left.position, right.position);
      for (float y : {0.0f, 40.0f})
        EXPECT_LT(glm::length(at_depth_1(left, 64, y) - at_depth_1(right, 0, y)), 1e-6f);
    }
  const View above = tile_view(wide, wall, 1, 0), below = tile_view(wide, wall, 1, 1);
  for (float x : {0.0f, 64.0f})
    EXPECT_LT(glm::length(at_depth_1(above, x, 40) - at_depth_1(below, x, 0)), 1e-6f);
}

TEST(Wall, FramesHideAsMuchAsTheyAreWide) {
  const WallPart wall = wall_of(3, 2, {0.1f, 0.25f});
  const WallSize tile{80, 40}, whole = wall_size(wall, tile);
  EXPECT_EQ(whole, (WallSize{3 * 80 + 2 * 8, 2 * 40 + 10}));
  const PictureWindow last = tile_window(wall, whole, 2, 1);
  EXPECT_EQ(last.left, 176);
  EXPECT_EQ(last.top, 50);
  EXPECT_EQ(last.left + last.width, whole.width);
  EXPECT_EQ(last.top + last.height, whole.height);
  // The window at a depth of 1 is as far to the right as tile and frame are wide.
  const View wide = wide_view(Scene(), whole);
  const float pixel = 2 * wide.tan_half_fov / float(wide.height);
  const vec3 gap = at_depth_1(tile_view(wide, wall, 1, 0), 0, 0) -
                   at_depth_1(tile_view(wide, wall, 0, 0), 80, 0);
  EXPECT_NEAR(glm::length(gap), 8 * pixel, 1e-5f);
}

TEST(Wall, TilesSeeWhatTheWidePictureSees) {
  const Exhibit exhibit = make_tiny_exhibit();
  const World world(exhibit.scene);
  const WallPart wall = wall_of(2, 2, {0.05f, 0.05f});
  const WallSize whole = wall_size(wall, {40, 40});
  const View wide = wide_view(exhibit.scene, whole);
  int seen = 0;
  for (int number = 0; number < 4; number++) {
    const PictureWindow window = tile_window(wall, whole, number % 2, number / 2);
    const View tile = window_view(wide, window);
    for (int y = 0; y < tile.height; y++)
      for (int x = 0; x < tile.width; x++) {
        const Hit one = world.intersect(view_ray(tile, float(x) + 0.5f, float(y) + 0.5f)),
                  same = world.intersect(
                      view_ray(wide, float(window.left + x) + 0.5f, float(window.top + y) + 0.5f));
        ASSERT_EQ(one.valid(), same.valid());
        ASSERT_NEAR(one.t, same.t, 1e-3f) << number << ": " << x << ", " << y;
        seen += one.valid();
      }
  }
  EXPECT_GT(seen, 6000);
}

TEST(Wall, ScreensThatTheWallDoesNotHaveShowNothing) {
  const WallPart wall = wall_of(2, 1);
  EXPECT_TRUE(tile_window(wall, {80, 40}, 2, 0).empty());
  EXPECT_TRUE(tile_window(wall, {80, 40}, 0, 1).empty());
}

TEST(Wall, WidePicturesAreBounded) {
  EXPECT_EQ(tile_size(wall_of(2, 2), {640, 360}, 1e7), (WallSize{640, 360}));
  const WallPart wide = wall_of(8, 1, {0.02f, 0});
  const WallSize tile = tile_size(wide, {1920, 1080}, 1e9);
  EXPECT_LE(wall_size(wide, tile).width, most_wall_pixels);
  EXPECT_NEAR(float(tile.width) / float(tile.height), 16 / 9.0f, 0.05f);
  const WallSize whole = wall_size(wall_of(4, 4), tile_size(wall_of(4, 4), {1920, 1080}, 4e6));
  EXPECT_LE(double(whole.width) * whole.height, 4e6);
  EXPECT_GT(double(whole.width) * whole.height, 3.5e6);
}

TEST(Wall, IsAsWideAsItSaysElseNotTooWide) {
  WallPart wall = wall_of(3, 1);
  const WallSize whole{3 * 160, 90};
  const auto across = [&](float fov) {
    return 2 * std::atan(std::tan(0.5f * fov) * float(whole.width) / float(whole.height));
  };
  EXPECT_NEAR(across(wall_fov(wall, whole, 1.0f)), 1.745f, 1e-3f);
  EXPECT_EQ(wall_fov(wall, whole, 0.3f), 0.3f);
  wall.fov = 2;
  EXPECT_NEAR(across(wall_fov(wall, whole, 0.3f)), 2, 1e-4f);
}

TEST(Wall, PartsThatCannotBeAreRefused) {
  WallPart part = wall_of(3, 2);
  EXPECT_EQ(check_part(part), nullptr) << "it leads the wall";
  part.column = 2, part.row = 1;
  EXPECT_EQ(check_part(part), nullptr);
  for (const auto& change :
       {+[](WallPart& one) { one.column = 3; }, +[](WallPart& one) { one.row = 2; },
        +[](WallPart& one) { one.row.reset(); },
        +[](WallPart& one) { one.columns = 8, one.rows = 3; },
        +[](WallPart& one) { one.bezel.y = -0.1f; }}) {
    WallPart wrong = part;
    change(wrong);
    EXPECT_NE(check_part(wrong), nullptr);
  }
}

}  // namespace
}  // namespace wellspring::test
