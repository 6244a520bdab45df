// SPDX-License-Identifier: Apache-2.0
// Scans are laid over pictures where they are nearer than what is drawn.
#include "picture/scan_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "picture/laid_view.h"
#include "scan/tree/coarse_cut.h"
#include "scenes/build.h"
#include "unit/scan/tree_made.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int side = 64;

// A wall of red points 2 m wide and high in the plane z = 0.
std::shared_ptr<const PointTree> red_wall() {
  PointBlock block;
  for (int x = 0; x < 200; x++)
    for (int y = 0; y < 200; y++) {
      block.place.push_back({0.01 * x - 1, 0.01 * y - 1, 0});
      block.color.push_back({255, 0, 0});
    }
  ScanInfo info;
  info.fields.color = true;
  return std::make_shared<PointTree>(
      make_tree(made_source(std::move(block), info), plain_settings()));
}

PlacedScan placed_at(vec3 position) {
  static const auto wall = red_wall();
  PlacedScan placed;
  placed.sets = {{wall}};
  // The tree's own zero is where its origin says.
  placed.position = position + vec3(wall->origin);
  placed.object = 5;
  const PointBounds box = bounds_of(coarse_cut(*wall, 100'000));
  placed.low = float(box.low.y), placed.high = float(box.high.y);
  return placed;
}

struct Stage {
  Scene scene = empty_scene();
  World world{scene};
  LaidWork work;
  View view;
  explicit Stage(std::vector<PlacedScan> scans) {
    world.place_scans(std::move(scans));
    view.width = view.height = side;
  }
  Laid middle(float surface = INFINITY) {
    const LaidView laid(laid_things(world, nullptr, nullptr, 1), view, vec2(0.5f), false, 0, work);
    return laid.look(side / 2, side / 2, all_lanes(surface));
  }
};

TEST(ScanView, ShowsPointsInTheirColourAndDepth) {
  Stage stage({placed_at({0, 0, -3})});
  const Laid laid = stage.middle();
  EXPECT_NEAR(laid.depth[0], 3, 0.02f);
  EXPECT_EQ(laid.object[0], 5u);
  EXPECT_EQ(laid.clear[0], 0);
  EXPECT_NEAR(laid.light.x[0], 1, 0.01f);
  EXPECT_NEAR(laid.light.y[0], 0, 0.01f);
}

TEST(ScanView, ASurfaceHidesWhatIsBehindIt) {
  Stage stage({placed_at({0, 0, -3})});
  const Laid hidden = stage.middle(2);
  EXPECT_EQ(hidden.clear[0], 1);
  EXPECT_EQ(hidden.light.x[0], 0);
  EXPECT_FALSE(std::isfinite(hidden.depth[0]));
}

TEST(ScanView, TheNearerScanIsSeen) {
  Stage stage({placed_at({0, 0, -5}), placed_at({0, 0, -3})});
  EXPECT_NEAR(stage.middle().depth[0], 3, 0.02f);
}

TEST(ScanView, AScaledScanLooksTheSameFromAsMuchFartherAway) {
  PlacedScan placed = placed_at({0, 0, 0});
  placed.scale = 10;
  placed.position = vec3(0, 0, -30) + 10.0f * vec3(placed.sets[0].points->origin);
  Stage stage({placed});
  EXPECT_NEAR(stage.middle().depth[0], 30, 0.2f);
}

TEST(ScanView, TurnsToTheLeft) {
  PlacedScan placed = placed_at({0, 0, 0});
  placed.turn = glm::angleAxis(0.5f * pi, vec3(0, 1, 0));
  placed.position = vec3(0, 0, -3) + placed.turn * vec3(placed.sets[0].points->origin);
  Stage stage({placed});
  // It is seen from its edge: away from the middle column there is nothing.
  const LaidView laid(laid_things(stage.world, nullptr, nullptr, 1), stage.view, vec2(0.5f), false,
                      0, stage.work);
  EXPECT_FALSE(std::isfinite(laid.look(48, side / 2, all_lanes(INFINITY)).depth[0]));
}

TEST(ScanView, LooksColourByHeightAndClass) {
  PlacedScan placed = placed_at({0, 0, -3});
  placed.look.colors = ScanColors::height;
  Stage stage({placed});
  const Laid half = stage.middle();
  placed.look.colors = ScanColors::classification;
  stage.world.show_scan(0, placed.look);
  const Laid grey = stage.middle();
  EXPECT_GT(half.light.y[0], half.light.x[0]) << "half the height is green";
  EXPECT_EQ(grey.light.x[0], grey.light.y[0]) << "without a class it is grey";
}

TEST(ScanView, NothingIsBehindTheEyeOrBeforeThePlaneOfTheCut) {
  Stage behind({placed_at({0, 0, 3})});
  EXPECT_FALSE(std::isfinite(behind.middle().depth[0]));
  Stage cut({placed_at({0, 0, -3})});
  cut.view.near = 4;
  EXPECT_FALSE(std::isfinite(cut.middle().depth[0]));
}

TEST(ScanView, PixelsBesideThePictureAreEmpty) {
  Stage stage({placed_at({0, 0, -1})});
  const LaidView laid(laid_things(stage.world, nullptr, nullptr, 1), stage.view, vec2(0.5f), false,
                      0, stage.work);
  const Laid left = laid.look(-4, 0, all_lanes(INFINITY)),
             right = laid.look(side - 4, side - 1, all_lanes(INFINITY));
  for (int k = 0; k < 4; k++) {
    EXPECT_FALSE(std::isfinite(left.depth[k]));
    EXPECT_FALSE(std::isfinite(right.depth[k + 4]));
  }
}

TEST(ScanView, RestIsTheMeanOverPlacesInThePixels) {
  Stage stage({placed_at({0, 0, -3})});
  Frame frame;
  fit_frame(side, side, frame);
  LaidLayer layer;
  for (int i = 0; i < 8; i++) {
    std::fill(frame.color.begin(), frame.color.end(), vec3(0, 0, 1));
    std::fill(frame.depth.begin(), frame.depth.end(), INFINITY);
    layer.lay_over(laid_things(stage.world, nullptr, nullptr, 1), stage.view, 1, stage.work, frame);
  }
  int edges = 0;
  for (size_t x = 0; x < side; x++) {
    const vec3 color = frame.color[side / 2 * side + x];
    EXPECT_NEAR(color.x + color.z, 1, 0.02f) << x;
    edges += color.x > 0.1f && color.x < 0.9f;
  }
  EXPECT_GE(edges, 1) << "no pixel of the edge is antialiased";
}

// Keeps what lies to the right of a place.
ScanCut right_of(float x) { return {{1, 0, 0}, x}; }

bool is_seen(Stage& stage, int x, bool settled = false) {
  const LaidView laid(laid_things(stage.world, nullptr, nullptr, 1), stage.view, vec2(0.5f),
                      settled, 0, stage.work);
  return std::isfinite(laid.look(x, side / 2, all_lanes(INFINITY)).depth[0]);
}

TEST(ScanView, ACutKeepsOneSideInTheScenesOwnCoordinates) {
  PlacedScan placed = placed_at({0, 0, 0});
  // Three times as large, and turned round: its left lies to the right.
  placed.turn = glm::angleAxis(pi, vec3(0, 1, 0)), placed.scale = 3;
  placed.position = vec3(0.3f, 0, -6) + placed.turn * (3.0f * vec3(placed.sets[0].points->origin));
  placed.look.cuts = {right_of(0.3f)};
  Stage stage({placed});
  // At a depth of 6 a pixel is 6 / 64 m wide.
  for (const bool settled : {false, true}) {
    EXPECT_FALSE(is_seen(stage, 32, settled)) << "0.05 m, 0.25 m beyond the cut";
    EXPECT_TRUE(is_seen(stage, 37, settled)) << "0.5 m";
  }
  stage.world.show_scan(0, {});
  EXPECT_TRUE(is_seen(stage, 32)) << "without the cut it is there";
}

TEST(ScanView, WhatIsBehindACutIsSeen) {
  PlacedScan cut = placed_at({0, 0, -3});
  cut.look.cuts = {{{0, 0, -1}, 3.5f}};  // nothing nearer than 3.5 m
  Stage stage({cut, placed_at({0, 0, -5})});
  EXPECT_NEAR(stage.middle().depth[0], 5, 0.02f);
}

TEST(ScanView, AtRestAnotherCutBeginsTheMeanAnew) {
  Stage stage({placed_at({0, 0, -3})});
  LaidLayer layer;
  auto draw = [&] {
    Frame frame;
    fit_frame(side, side, frame);
    std::fill(frame.depth.begin(), frame.depth.end(), INFINITY);
    layer.lay_over(laid_things(stage.world, nullptr, nullptr, 1), stage.view, 1, stage.work, frame);
    return frame.depth[side / 2 * side + side / 2];
  };
  EXPECT_NEAR(draw(), 3, 0.02f);
  ScanLook look;
  look.cuts = {right_of(0.5f)};
  stage.world.show_scan(0, look);
  EXPECT_FALSE(std::isfinite(draw()));
}

}  // namespace
}  // namespace wellspring::test
