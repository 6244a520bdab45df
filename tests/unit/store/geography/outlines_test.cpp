// SPDX-License-Identifier: Apache-2.0
// Outlines: a window gets what touches it and no more, and windows beside one another agree.
#include "store/geography/outlines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"

namespace wellspring::test {
namespace {

using store::GeoBox;
using store::GeoOutlines;
using store::GeoPiece;
using store::GeoWindow;

GeoWindow window_of(const GeoBox& texels, double scale = 1) {
  return store::make_geo_window({scale, 0}, {0, scale}, dvec2(0), texels, 3);
}

double area_of(const std::vector<dvec2>& ring) {
  double area = 0;
  for (size_t i = 0; i < ring.size(); i++) {
    const dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    area += 0.5 * (a.x * b.y - b.x * a.y);
  }
  return std::abs(area);
}

// Makes a rough ring around a place.
std::vector<dvec2> rough_ring(int count, dvec2 middle, double radius) {
  std::vector<dvec2> ring;
  for (int i = 0; i < count; i++) {
    const double turn = 2 * double(pi) * i / count;
    const double far = radius * (1 + 0.2 * std::sin(7 * turn) + 0.02 * std::sin(251 * turn));
    ring.push_back(middle + far * dvec2(std::cos(turn), std::sin(turn)));
  }
  return ring;
}

TEST(Outlines, ABoxTreeFindsWhatTouchesInOrder) {
  std::vector<GeoBox> boxes;
  for (int i = 0; i < 1000; i++) boxes.push_back({dvec2(i % 37, i / 37), dvec2(i % 37, i / 37)});
  const store::GeoBoxTree tree(boxes);
  const GeoBox part{{3.5, 4.5}, {8.5, 20.5}};
  std::vector<size_t> found, expected;
  tree.visit(part, [&](size_t i) { found.push_back(i); });
  for (size_t i = 0; i < boxes.size(); i++)
    if (boxes[i].touches(part)) expected.push_back(i);
  EXPECT_EQ(expected.size(), 5u * 16u);
  EXPECT_EQ(found, expected);
  store::GeoBoxTree().visit(part, [&](size_t) { ADD_FAILURE(); });
}

TEST(Outlines, ARingThatIsClippedHasTheAreaThatTheWindowSees) {
  const std::vector<dvec2> ring = rough_ring(20000, {1000, 1000}, 700);
  GeoOutlines outlines;
  outlines.add(ring.data(), ring.size(), true);
  double sum = 0;
  std::vector<dvec2> corners;
  // Windows without room around that cover the plane.
  for (int y = 0; y < 2048; y += 256)
    for (int x = 0; x < 2048; x += 256) {
      const GeoBox texels{dvec2(x, y), dvec2(x + 256, y + 256)};
      const GeoWindow window = store::make_geo_window({1, 0}, {0, 1}, dvec2(0), texels, 0);
      store::clip_ring(outlines, outlines.lines[0], window, corners);
      for (dvec2 p : corners) {
        EXPECT_GE(p.x, x - 1e-9);
        EXPECT_LE(p.x, x + 256 + 1e-9);
      }
      sum += area_of(corners);
    }
  EXPECT_NEAR(sum, area_of(ring), 1e-4 * area_of(ring));
}

TEST(Outlines, AWindowFarInsideARingIsAllOfIt) {
  const std::vector<dvec2> ring = rough_ring(5000, {0, 0}, 1e6);
  GeoOutlines outlines;
  outlines.add(ring.data(), ring.size(), true);
  const GeoWindow window = window_of({dvec2(0), dvec2(256)});
  std::vector<dvec2> corners;
  store::clip_ring(outlines, outlines.lines[0], window, corners);
  const dvec2 size = window.texels.high - window.texels.low;
  EXPECT_NEAR(area_of(corners), size.x * size.y, 1e-6);
  std::vector<GeoPiece> pieces;
  corners.clear();
  store::cut_line(outlines, outlines.lines[0], window, corners, pieces);
  EXPECT_TRUE(corners.empty());
}

TEST(Outlines, WindowsAgreeAboutALineThatCrossesBoth) {
  const dvec2 line[] = {{-31234.5, 17.25}, {91234.125, 203.5}, {91000, -3e6}};
  GeoOutlines outlines;
  outlines.add(line, 3, false);
  std::vector<dvec2> left, right, both;
  std::vector<GeoPiece> pieces;
  store::cut_line(outlines, outlines.lines[0], window_of({{0, 0}, {256, 256}}), left, pieces);
  EXPECT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(pieces[0].before, 31234.5 - 64, 1) << "it begins on the grid before the window";
  store::cut_line(outlines, outlines.lines[0], window_of({{256, 0}, {512, 256}}), right, pieces);
  store::cut_line(outlines, outlines.lines[0], window_of({{0, 0}, {512, 256}}), both, pieces);
  EXPECT_LT(both.size(), 20u) << "what is far away is not cut";
  // Within both windows the corners are the same numbers.
  for (const auto* part : {&left, &right})
    for (dvec2 p : *part)
      EXPECT_TRUE(p.x < 64 || p.x > 448 || std::ranges::count(both, p) > 0) << p.x;
}

TEST(Outlines, PointsThatCannotBeToldApartAreLeftOut) {
  const std::vector<dvec2> ring = rough_ring(100000, {128, 128}, 90);
  GeoOutlines outlines;
  outlines.add(ring.data(), ring.size(), true);
  std::vector<dvec2> corners;
  std::vector<GeoPiece> pieces;
  store::cut_line(outlines, outlines.lines[0], window_of({dvec2(0), dvec2(256)}), corners, pieces);
  EXPECT_LT(corners.size(), 10000u);
  EXPECT_GT(corners.size(), 1000u);
}

TEST(Outlines, TakesAnyNumbers) {
  Rng rng(1);
  for (int round = 0; round < 300; round++) {
    std::vector<dvec2> line;
    for (int i = 0; i < 20; i++) {
      const double far = std::pow(10, 12 * rng.uniform() - 3);
      line.push_back(far * (2.0 * dvec2(rng.uniform(), rng.uniform()) - 1.0));
    }
    if (round % 3 == 0) line[3] = line[4] = line[5];
    GeoOutlines outlines;
    outlines.add(line.data(), line.size(), round % 2 == 0);
    std::vector<dvec2> corners;
    std::vector<GeoPiece> pieces;
    const GeoWindow window = window_of({dvec2(-100), dvec2(156)});
    store::cut_line(outlines, outlines.lines[0], window, corners, pieces);
    for (dvec2 p : corners) EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
    EXPECT_LT(corners.size(), 1000u);
    store::clip_ring(outlines, outlines.lines[0], window, corners);
    for (dvec2 p : corners) EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
  }
}

}  // namespace
}  // namespace wellspring::test
