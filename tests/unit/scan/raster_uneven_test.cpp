// SPDX-License-Identifier: Apache-2.0
// Points of one node that lie unevenly are drawn as large as their own neighbours are far.
#include <gtest/gtest.h>

#include "raster_scene.h"
#include "scan/draw/fill_holes.h"
#include "tree_made.h"

namespace wellspring::test {
using namespace wellspring::scan;

namespace {

// Two halves of a wall, the right one with a ninth of the points of the left one.
const Surfaces dense{.rectangles = {{{-1, -1, 0}, {1, 0, 0}, {0, 2, 0}}}, .balls = {}};
const Surfaces sparse{.rectangles = {{{0, -1, 0}, {1, 0, 0}, {0, 2, 0}}}, .balls = {}};
constexpr double dense_spacing = 0.01, sparse_spacing = 0.03;

// Returns a tree that is one leaf.
PointTree made_leaf(const std::vector<dvec3>& places) {
  PointBlock block;
  block.place = places;
  block.normal.assign(places.size(), vec3(0, 0, 1));
  ScanInfo info;
  info.fields.normal = true;
  PointTree tree = make_tree(made_source(block, info), plain_settings(1'000'000));
  EXPECT_EQ(tree.nodes.size(), 1u);
  return tree;
}

std::vector<dvec3> uneven_wall() {
  std::vector<dvec3> places;
  const auto add = [&](dvec3 place, dvec3) { places.push_back(place); };
  dense.scatter(dense_spacing, 1, add);
  sparse.scatter(sparse_spacing, 2, add);
  return places;
}

PointBuffer drawn(const PointTree& tree, const ScanCamera& view) {
  const NodePoints node = tree.points_of(0);
  PointBuffer buffer;
  PointRaster().draw(buffer, {&node, 1}, view, {});
  fill_holes(buffer, {&node, 1}, view);
  return buffer;
}

ScanCamera view_of(const PointTree& tree, dvec3 eye) {
  ScanCamera view;
  view.width = 240, view.height = 180, view.eye = eye - tree.origin;
  return view;
}

TEST(UnevenPoints, EachIsKnownByTheDistanceOfItsNeighbours) {
  const PointTree tree = made_leaf(uneven_wall());
  const NodePoints node = tree.points_of(0);
  double sum[2] = {}, count[2] = {};
  for (uint32_t i = 0; i < node.count; i++) {
    const double x = place_of(node, i).x + tree.origin.x;
    if (std::abs(x) < 0.1) continue;
    sum[x > 0] += double(node.own_spacing[i]) / double(own_spacing_steps) * double(node.spacing);
    count[x > 0]++;
  }
  EXPECT_NEAR(sum[0] / count[0], dense_spacing, 0.3 * dense_spacing);
  EXPECT_NEAR(sum[1] / count[1], sparse_spacing, 0.3 * sparse_spacing);
}

TEST(UnevenPoints, ASparseWallHasNoHolesAndIsNoWiderThanItsPointsAreApart) {
  const PointTree tree = made_leaf(uneven_wall());
  for (const double away : {1.5, 2.5}) {
    const ScanCamera view = view_of(tree, {0.1, 0.05, away});
    PointBuffer buffer = drawn(tree, view);
    ScanCamera seen = view;
    seen.eye += tree.origin;
    const double pixels = sparse_spacing * double(view.focal()) / away;
    const Surfaces wall{.rectangles = {dense.rectangles[0], sparse.rectangles[0]}, .balls = {}};
    const Verdict v = judge(buffer, wall, seen, 0.01, std::max(1.0, pixels));
    EXPECT_LE(v.holes, v.covered / 400) << away;
    EXPECT_EQ(v.fattened, 0) << away;
  }
}

// A point in the air between two surfaces, as scanners give them, is no larger than others.
TEST(UnevenPoints, APointThatLiesAloneStaysSmall) {
  std::vector<dvec3> places;
  const auto add = [&](dvec3 place, dvec3) { places.push_back(place); };
  dense.scatter(dense_spacing, 1, add);
  places.push_back({0.5, 0, 0});
  const PointTree tree = made_leaf(places);
  const ScanCamera view = view_of(tree, {0, 0, 1.5});
  const PointBuffer buffer = drawn(tree, view);
  const int middle = view.width / 2 + int(0.2 * double(view.focal()) / 1.5);
  int seen = 0;
  for (int y = 0; y < view.height; y++)
    for (int x = middle; x < view.width; x++)
      seen += std::isfinite(buffer.depth[size_t(y * view.width + x)]);
  const double radius = dense_spacing * double(view.focal()) / 1.5;
  EXPECT_GT(seen, 0);
  EXPECT_LE(seen, std::max(4.0, 4 * radius * radius));
}

}  // namespace
}  // namespace wellspring::test
