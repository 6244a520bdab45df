// SPDX-License-Identifier: Apache-2.0
// Points that are spheres are drawn as these, in depth and normal, however near they are.
#include <gtest/gtest.h>

#include "raster_scene.h"

namespace wellspring::test {
using namespace wellspring::scan;

namespace {

struct Pictured {
  PointBuffer buffer;
  int seen = 0, wrong = 0;  // pixels that see a sphere; that see one where none is, or none
  double depth_error = 0, normal_error = 0;  // largest, relative to the radius
};

// Draws balls of one radius, and compares all pixels with rays.
Pictured compare(const std::vector<Ball>& balls, const ScanCamera& view, dvec3 corner, float size) {
  PointSet set;
  set.corner = corner, set.size = size;
  Surfaces surfaces;
  for (const Ball& ball : balls) {
    set.add(ball.middle, vec3(0, 1, 0), 0xff0000ff);
    // The place that the node can hold.
    const uint32_t i = set.count - 1;
    Ball held = ball;
    held.middle = corner + (dvec3(set.x[i], set.y[i], set.z[i]) + 0.5) * (double(size) / 65536);
    surfaces.balls.push_back(held);
  }
  const DiscStyle style{.spheres = true, .blended = true};
  set.spacing = float(balls[0].radius) / style.radius;
  const NodePoints node = set.lend();
  Pictured pictured;
  PointRaster().draw(pictured.buffer, {&node, 1}, view, style);
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      const size_t at = size_t(y * view.width + x);
      const double truth = surfaces.depth_at(view, x, y);
      const double seen = double(pictured.buffer.depth[at]);
      if (std::isfinite(seen) != std::isfinite(truth)) pictured.wrong++;
      if (!std::isfinite(seen) || !std::isfinite(truth)) continue;
      pictured.seen++;
      pictured.depth_error =
          std::max(pictured.depth_error, std::abs(seen - truth) / balls[0].radius);
      const vec3 normal = point_normal(pictured.buffer.normal[at]);
      const vec2 from = vec2(float(x), float(y)) + view.offset - view.axis_place();
      const dvec3 place =
          view.eye +
          truth * dvec3(view.forward + (view.right * from.x - view.up * from.y) / view.focal());
      double least = INFINITY;
      for (const Ball& ball : surfaces.balls)
        least = std::min(least, length(dvec3(normal) - (place - ball.middle) / ball.radius));
      pictured.normal_error = std::max(pictured.normal_error, least);
    }
  return pictured;
}

ScanCamera view_of(int width, int height) {
  ScanCamera view;
  view.width = width, view.height = height;
  view.tan_half_fov = 0.5f;
  return view;
}

TEST(RasterSpheres, SmallOnesAreRoundAndKnowTheirNormals) {
  std::vector<Ball> balls;
  for (int i = 0; i < 9; i++)
    balls.push_back({{0.2 * (i % 3) - 0.2, 0.2 * (i / 3) - 0.2, -3}, 0.05});
  const Pictured pictured = compare(balls, view_of(400, 300), dvec3(-2, -2, -4), 4);
  EXPECT_GT(pictured.seen, 9 * 75);
  EXPECT_LT(pictured.wrong, pictured.seen / 20);  // rims
  EXPECT_LT(pictured.depth_error, 0.35);          // at rims, too
  EXPECT_LT(pictured.normal_error, 0.4);
}

TEST(RasterSpheres, OneBeforeTheEyeIsAsLargeAsItIs) {
  for (const dvec3 middle : {dvec3(0, 0, -1), dvec3(0.45, -0.3, -1.1)}) {
    const Pictured pictured = compare({{middle, 0.3}}, view_of(400, 300), dvec3(-2, -2, -4), 4);
    EXPECT_GT(pictured.seen, 10'000);
    EXPECT_LT(pictured.wrong, pictured.seen / 200);
    EXPECT_LT(pictured.depth_error, 0.05);
    EXPECT_LT(pictured.normal_error, 0.06);
  }
}

TEST(RasterSpheres, OnesBesideTheEyeAreSeenAsFarAsTheyAreInThePicture) {
  const std::vector<Ball> balls = {
      {{0.9, 0, -0.1}, 0.3}, {{0.35, 0, -0.2}, 0.3}, {{0, 0, -1}, 0.3}};
  const Pictured pictured = compare(balls, view_of(200, 200), dvec3(-2, -2, -4), 4);
  EXPECT_GT(pictured.seen, 10'000);
  EXPECT_LT(pictured.wrong, pictured.seen / 100);
  EXPECT_LT(pictured.depth_error, 0.05);
}

TEST(RasterSpheres, NearerOnesHideOthersAndTheEyeMayBeInside) {
  const Pictured pictured = compare({{{0, 0, -1}, 0.2}, {{0.1, 0, -1.1}, 0.2}, {{0, 0.1, -2}, 0.2}},
                                    view_of(200, 200), dvec3(-2, -2, -4), 4);
  EXPECT_LT(pictured.wrong, pictured.seen / 100);
  EXPECT_LT(pictured.depth_error, 0.05);
  // Who stands in a sphere sees out of it.
  const Pictured inside = compare({{{0, 0, -0.1}, 0.5}}, view_of(100, 100), dvec3(-2, -2, -4), 4);
  EXPECT_EQ(inside.seen, 0);
  EXPECT_EQ(inside.buffer.color[50 * 100 + 50], 0u);
}

}  // namespace
}  // namespace wellspring::test
