// SPDX-License-Identifier: Apache-2.0
// The tools of the report on light: plots, curves, references and finer meshes.
#include <gtest/gtest.h>

#include <cmath>

#include "benchmark/light_curve.h"
#include "benchmark/light_reference.h"
#include "benchmark/plot.h"
#include "benchmark/tessellate.h"
#include "scenes/lit_world.h"

namespace wellspring::test {
namespace {

size_t count_of(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) count++;
  return count;
}

// The points of the n-th polyline.
std::vector<std::pair<double, double>> polyline(const std::string& svg, int n) {
  size_t at = 0;
  for (int i = 0; i <= n; i++) at = svg.find("<polyline points=\"", at + 1);
  std::vector<std::pair<double, double>> points;
  const char* p = svg.c_str() + at + 18;
  double x, y;
  for (int used = 0; std::sscanf(p, "%lf,%lf %n", &x, &y, &used) == 2; p += used)
    points.push_back({x, y});
  return points;
}

std::vector<CurvePoint> falling(double first, int count) {
  std::vector<CurvePoint> curve;
  for (int i = 0; i < count; i++)
    curve.push_back({1 << i, double(1 << i), first * std::pow(0.5, 0.5 * i), 0, 0, 0});
  return curve;
}

TEST(Plot, PowersLieOnStraightLines) {
  Plot plot{"a < b & c", "", "x", "y", {{"one", {}}, {"none", {}}}, 0.1, "level"};
  for (int i = 0; i < 5; i++) plot.curves[0].points.push_back({std::pow(10, i), std::pow(0.1, i)});
  plot.curves[1].points = {{0, 1}, {-1, 2}, {1, NAN}, {1, INFINITY}};  // nothing to draw
  std::string svg = make_svg(plot);
  EXPECT_EQ(count_of(svg, "<polyline"), 1u);
  EXPECT_EQ(count_of(svg, "a &lt; b &amp; c"), 1u);
  EXPECT_EQ(count_of(svg, "nan"), 0u);
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
  auto points = polyline(svg, 0);
  ASSERT_EQ(points.size(), 5u);
  for (size_t i = 1; i < 5; i++) {
    EXPECT_NEAR(points[i].first - points[i - 1].first, points[1].first - points[0].first, 0.02);
    EXPECT_NEAR(points[i].second - points[i - 1].second, points[1].second - points[0].second, 0.02);
  }
  EXPECT_GT(points[1].first, points[0].first);
  EXPECT_GT(points[1].second, points[0].second);  // down the page
  EXPECT_NE(make_svg(Plot{}).find("</svg>"), std::string::npos);
}

TEST(Curve, TimeToAnErrorIsReadFromTheLogarithms) {
  // Error halves with four times the time: 0.4 at 1 s is 0.1 at 16 s.
  Reached between = time_to_flip(falling(0.4, 8), 0.1);
  EXPECT_NEAR(between.seconds, 16, 1e-9);
  EXPECT_TRUE(between.measured);
  Reached beyond = time_to_flip(falling(0.4, 4), 0.1);  // up to 8 s
  EXPECT_NEAR(beyond.seconds, 16, 1e-9);
  EXPECT_FALSE(beyond.measured);
  EXPECT_EQ(time_to_flip(falling(0.4, 4), 0.01).seconds, 0);  // too far to tell
  EXPECT_EQ(time_to_flip(falling(0.05, 4), 0.1).seconds, 1);
  EXPECT_EQ(time_to_flip({}, 0.1).seconds, 0);
  std::vector<CurvePoint> level = falling(0.4, 4);
  for (CurvePoint& p : level) p.flip = 0.4;
  EXPECT_EQ(time_to_flip(level, 0.1).seconds, 0);
}

// The reference's estimate of its own noise agrees with a far better picture.
TEST(ReferencePicture, KnowsItsNoise) {
  auto [scene, world, lights] = scenes::LitWorld(scenes::make_cornell_box());
  // Below the lamp, whose edges would decide alone.
  View view = make_view_towards(scene, {0, 0.2, 0.3}, {0, 0.1, -0.3}, {0, 1, 0}, 0.5f, 24, 24);
  Reference quick = make_reference(world, lights, view, {}, 0);  // two pieces of eight
  EXPECT_EQ(quick.spp, 16);
  Frame truth =
      render_still(*find_technique("path"), world, lights, view, {.spp = 1024, .seed = 99});
  // Pixels are independent: their squared errors tell how exact their mean is, and the reference's
  // own estimate of it is as exact. Two-sided, 1 in 10,000.
  double sum = 0, squares = 0, n = double(truth.color.size());
  for (size_t i = 0; i < truth.color.size(); i++) {
    dvec3 d = dvec3(quick.frame.color[i]) - dvec3(truth.color[i]);
    double e = dot(d, d) / 3;
    sum += e;
    squares += e * e;
  }
  double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / (n - 1));
  EXPECT_LT(std::abs(quick.rmse * quick.rmse - mean), 3.89 * std::sqrt(2.0) * error);
  EXPECT_LT(error, 0.2 * mean);
  EXPECT_GT(quick.flip, 0);
}

TEST(Tessellate, SameSurfacesInMoreTriangles) {
  Scene scene = scenes::make_cornell_box();
  Scene fine = tessellate(scene, 5000);
  EXPECT_NEAR(double(triangle_count(fine)), 5000, 700);
  World coarse_world(scene), fine_world(fine);
  View view = scenes::cornell_view(scene, 40, 40);
  for (int y = 0; y < 40; y++)
    for (int x = 0; x < 40; x++) {
      Ray ray = view_ray(view, float(x) + 0.37f, float(y) + 0.61f);
      Hit a = coarse_world.intersect(ray), b = fine_world.intersect(ray);
      ASSERT_EQ(a.valid(), b.valid());
      if (!a.valid()) continue;
      EXPECT_EQ(a.instance, b.instance);
      EXPECT_NEAR(a.t, b.t, 1e-5f);
    }
  size_t lamp = 0;
  for (size_t i = 0; i < scene.meshes.size(); i++)
    if (scene.materials[size_t(scene.meshes[i].material)].emission != vec3(0)) lamp = i;
  EXPECT_EQ(fine.meshes[lamp].triangles.size(), 2u);
}

}  // namespace
}  // namespace wellspring::test
