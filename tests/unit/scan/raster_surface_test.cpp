// SPDX-License-Identifier: Apache-2.0
// Points scattered over known surfaces are drawn as these: without holes, right in depth, and no
// wider than they are.
#include <gtest/gtest.h>

#include "raster_scene.h"
#include "scan/draw/fill_holes.h"

namespace wellspring::test {
using namespace wellspring::scan;

namespace {

PointBuffer drawn(PointSet& set, const ScanCamera& view, bool filled, bool blended = false) {
  const NodePoints node = set.lend();
  PointBuffer buffer;
  PointRaster().draw(buffer, {&node, 1}, view, {.blended = blended});
  if (filled) fill_holes(buffer, {&node, 1}, view);
  return buffer;
}

ScanCamera view_of(int width, int height, dvec3 eye) {
  ScanCamera view;
  view.width = width, view.height = height, view.eye = eye;
  return view;
}

}  // namespace

TEST(PointRaster, shows_a_wall_without_holes_from_a_metre_on) {
  const double spacing = 0.01;
  const Surfaces wall{.rectangles = {{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}}, .balls = {}};
  PointSet set = scattered(wall, spacing, {-2, -2, -2}, 4);
  for (const double away : {1.0, 1.7, 3.0, 6.0}) {
    ScanCamera view = view_of(240, 180, {0.1, 0.05, away});
    const double pixels = spacing * double(view.focal()) / away;
    const PointBuffer buffer = drawn(set, view, true);
    const Verdict v = judge(buffer, wall, view, 0.01, std::max(1.0, 0.5 * pixels));
    EXPECT_LE(v.holes, v.covered / 1000) << away;
    EXPECT_EQ(v.fattened, 0) << away;
    EXPECT_LT(v.error, 1e-4) << away;
  }
}

TEST(PointRaster, shows_a_ball_before_a_wall) {
  const double spacing = 0.008;
  const Surfaces scene{.rectangles = {{{-1.5, -1, -1}, {3, 0, 0}, {0, 2, 0}}},
                       .balls = {{{0, 0, 0}, 0.4}}};
  for (const bool blended : {false, true}) {
    PointSet set = scattered(scene, spacing, {-2, -2, -2}, 4);
    const ScanCamera view = view_of(240, 180, {0, 0, 1.6});
    const PointBuffer buffer = drawn(set, view, true, blended);
    const Verdict v = judge(buffer, scene, view, 0.05, 1);
    EXPECT_LE(v.holes, v.covered / 1000);
    EXPECT_LE(v.fattened, v.covered / 1000);
    EXPECT_LT(v.error, 1e-3);
    // Its normal is the place's.
    for (int y = 50; y < 130; y += 10)
      for (int x = 80; x < 160; x += 10) {
        const size_t at = size_t(y * view.width + x);
        if (buffer.depth[at] > 1.6f) continue;
        const float depth = buffer.depth[at], f = view.focal();
        const vec3 place(depth * (float(x) - 119.5f) / f, depth * (89.5f - float(y)) / f,
                         1.6f - depth);
        EXPECT_LT(length(point_normal(buffer.normal[at]) - place / 0.4f), 0.06f);
      }
  }
}

TEST(PointRaster, shows_a_room_through_a_doorway) {
  // A wall with a doorway of a metre, and a room behind it; the eye is before it.
  const Surfaces room{.rectangles = {{{-2, -1, 0}, {1.5, 0, 0}, {0, 2.5, 0}},
                                     {{0.5, -1, 0}, {1.5, 0, 0}, {0, 2.5, 0}},
                                     {{-0.5, 1, 0}, {1, 0, 0}, {0, 0.5, 0}},
                                     {{-2, -1, -3}, {4, 0, 0}, {0, 2.5, 0}},
                                     {{-2, -1, -3}, {0, 0, 6}, {4, 0, 0}}},
                      .balls = {}};
  PointSet set = scattered(room, 0.01, {-4, -4, -4}, 8);
  const ScanCamera view = view_of(320, 240, {0.3, 0.2, 2});
  const Verdict v = judge(drawn(set, view, true), room, view, 0.05, 1);
  EXPECT_LE(v.holes, v.covered / 1000);
  EXPECT_LE(v.fattened, v.covered / 1000);
  EXPECT_LT(v.error, 2e-3);
}

TEST(FillHoles, closes_what_shows_through_and_keeps_silhouettes) {
  // Two walls, the nearer one covers the left half and has gaps of a pixel; nothing is beyond.
  const Surfaces near{.rectangles = {{{-1, -1, 0}, {1, 0, 0}, {0, 2, 0}}}, .balls = {}};
  ScanCamera view = view_of(128, 96, {0, 0, 1});
  view.tan_half_fov = 0.75f;
  PointSet set = scattered(near, 0.014, {-2, -2, -2}, 4);
  const NodePoints node = set.lend();
  PointBuffer buffer;
  buffer.resize(view.width, view.height);
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      const size_t at = size_t(y * view.width + x);
      const bool is_gap = x % 4 == 2 && y % 3 == 1;
      if (y < 48) buffer.depth[at] = 4, buffer.node[at] = 0, buffer.color[at] = 1;
      if (x < 64 && !is_gap) buffer.depth[at] = 1, buffer.node[at] = 0, buffer.color[at] = 2;
    }
  fill_holes(buffer, {&node, 1}, view);
  for (int y = 1; y < view.height - 1; y++)
    for (int x = 1; x < view.width; x++) {
      const float depth = buffer.depth[size_t(y * view.width + x)];
      if (x < 64) {
        EXPECT_EQ(depth, 1) << x << " " << y;
      } else {
        EXPECT_EQ(std::isfinite(depth), y < 48) << x << " " << y;
        if (y < 48) {
          EXPECT_EQ(depth, 4) << x << " " << y;
        }
      }
    }
}

TEST(FillHoles, leaves_openings_wider_than_gaps) {
  // A wall with a slit of six pixels whose points are a pixel apart.
  ScanCamera view = view_of(64, 64, {0, 0, 1});
  PointSet set;
  set.spacing = 1 / view.focal();
  const NodePoints node = set.lend();
  PointBuffer buffer;
  buffer.resize(64, 64);
  for (int i = 0; i < 64 * 64; i++)
    if (i % 64 < 29 || i % 64 >= 35) buffer.depth[size_t(i)] = 1, buffer.node[size_t(i)] = 0;
  const PointBuffer before = buffer;
  fill_holes(buffer, {&node, 1}, view);
  EXPECT_EQ(buffer.depth, before.depth);
}

TEST(PointRaster, averages_discs_that_overlap) {
  // Points of two colours side by side: their mean is seen in linear light, not one or the other.
  PointSet set;
  set.corner = {-0.5, -0.5, -2.5}, set.spacing = 0.08f;
  for (int x = 0; x < 64; x++)
    for (int y = 0; y < 64; y++)
      set.add_place(x * 1024, y * 1024, 32768, (x + y) % 2 ? 0x64ffffffu : 0xc8000000u,
                    PointSet::normal_of({0, 0, 1}));
  const ScanCamera view = view_of(64, 64, {0, 0, 0});
  const PointBuffer buffer = drawn(set, view, false, true);
  for (int y = 20; y < 44; y++)
    for (int x = 20; x < 44; x++) {
      const uint32_t color = buffer.color[size_t(y * 64 + x)];
      EXPECT_NEAR(int(color & 255), 188, 8);
      EXPECT_NEAR(int(color >> 24), 150, 6);
    }
}

}  // namespace wellspring::test
