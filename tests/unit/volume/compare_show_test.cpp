// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>

#include "compare_solids.h"
#include "volume/compare/colored_glb.h"
#include "volume/compare/report.h"

namespace wellspring::test {
namespace {

Deviation deviation_of(double mm, bool found = true) {
  Deviation one;
  one.found = found;
  if (found) one.distance = float(mm / 1000);
  return one;
}

TEST(CompareColors, ScalesHaveRoundTicks) {
  const ColorScale scale = distance_scale(0.73);
  ASSERT_GE(scale.ticks.size(), 4u);
  ASSERT_LE(scale.ticks.size(), 11u);
  EXPECT_NEAR(scale.ticks[1].value - scale.ticks[0].value, 0.2, 1e-12);
  for (const ColorTick& tick : scale.ticks)
    EXPECT_NEAR(tick.position, (tick.value + 0.73) / 1.46, 1e-12);
  EXPECT_EQ(angle_scale(45).ticks.back().value, 40);
  for (double range : {1e-6, 0.01, 1.0, 1.9, 5.0, 1e4}) {
    EXPECT_GE(distance_scale(range).ticks.size(), 4u) << range;
    EXPECT_LE(distance_scale(range).ticks.size(), 11u) << range;
  }
}

TEST(CompareColors, MissingIsYellowExcessBlueAndNothingWhite) {
  const ColorScale scale = distance_scale(1);
  const auto colors =
      deviation_colors(scale, {deviation_of(0), deviation_of(0.5), deviation_of(-0.5),
                               deviation_of(99), deviation_of(1), deviation_of(0, false)});
  EXPECT_EQ(colors[0], vec3(1));
  EXPECT_GT(colors[1].x, 2 * colors[1].z);
  EXPECT_GT(colors[2].z, 2 * colors[2].x);
  EXPECT_EQ(colors[3], colors[4]);
  EXPECT_EQ(colors[5].x, colors[5].z);
  EXPECT_LT(colors[5].x, 0.5f);
}

TEST(CompareLens, ABoxPlotSumsUp) {
  std::vector<SurfacePoint> points(6);
  std::vector<Deviation> found;
  for (double mm : {1.0, 2.0, 3.0, 4.0, 10.0}) found.push_back(deviation_of(mm));
  found.push_back(deviation_of(0, false));
  for (size_t i = 0; i < 6; i++) points[i] = {dvec3(double(i), 0, 0), vec3(0, 1, 0), 0, 1};
  for (Deviation& one : found) one.cone_base = 0.25f;
  const BoxPlot plot = box_plot(points, found, {0, 1, 2, 3, 4, 5});
  EXPECT_EQ(plot.count, 6u);
  EXPECT_EQ(plot.found, 5u);
  EXPECT_NEAR(plot.least, 0.001, 1e-9);
  EXPECT_NEAR(plot.lower_quartile, 0.002, 1e-9);
  EXPECT_NEAR(plot.median, 0.003, 1e-9);
  EXPECT_NEAR(plot.upper_quartile, 0.004, 1e-9);
  EXPECT_NEAR(plot.greatest, 0.01, 1e-9);
  EXPECT_NEAR(plot.mean, 0.004, 1e-9);
  EXPECT_NEAR(plot.deviation, std::sqrt(10.0) / 1000, 1e-8);
  EXPECT_NEAR(plot.diameter, 0.25, 1e-9);
  EXPECT_EQ(plot.normal, vec3(0, 1, 0));
  EXPECT_NEAR(plot.position.x, 2.5, 1e-12);
  EXPECT_EQ(box_plot(points, found, {}).count, 0u);
}

TEST(CompareLens, NeighbourhoodsOfTheLensHaveAPlotAndAGlyphEach) {
  std::vector<SurfacePoint> points;
  std::vector<Deviation> found;
  for (int x = -20; x <= 20; x++)
    for (int y = -20; y <= 20; y++) {
      points.push_back({dvec3(x, y, 0) / 1000.0, vec3(0, 0, 1), 0, 1});
      found.push_back(deviation_of(x < 0 ? -1 : x == 0 ? 0.01 : 1));
    }
  const LensArea lens{dvec3(0), 0.01001};
  const auto plots = lens_plots(points, found, lens, 0.005);
  size_t count = 0;
  for (const BoxPlot& plot : plots) count += plot.count;
  EXPECT_EQ(count, 317u);  // points of whole numbers in a circle of radius 10
  EXPECT_EQ(plots.size(), 21u);
  const auto glyphs = lens_glyphs(points, found, lens, 0.005, 0.0001);
  ASSERT_EQ(glyphs.size(), plots.size());
  for (const DistanceGlyph& glyph : glyphs) {
    const double x = glyph.position.x;
    EXPECT_EQ(glyph.side, x < -1e-9  ? FoundSide::outside
                          : x > 1e-9 ? FoundSide::inside
                                     : FoundSide::none);
    EXPECT_NEAR(glyph.arrow, x < -1e-9 ? 0.001 : x > 1e-9 ? -0.001 : 0, 1e-9);
    if (glyph.side == FoundSide::none) {
      EXPECT_EQ(glyph.disc_color, vec3(1));
    }
  }
  EXPECT_TRUE(lens_plots(points, found, {dvec3(5), 1}, 0.1).empty());
}

TEST(CompareStatistics, PointsCountByTheirArea) {
  std::vector<SurfacePoint> points(4);
  points[0].area = 3, points[1].area = 1, points[2].area = 0, points[3].area = 4;
  const DeviationSummary summary = summarize(
      points, {deviation_of(1), deviation_of(5), deviation_of(-9), deviation_of(0, false)});
  EXPECT_EQ(summary.points, 4u);
  EXPECT_EQ(summary.found, 3u);
  EXPECT_NEAR(summary.not_found_share, 0.5, 1e-12);
  EXPECT_NEAR(summary.least, -0.009, 1e-9);
  EXPECT_NEAR(summary.greatest, 0.005, 1e-9);
  EXPECT_NEAR(summary.mean, 0.002, 1e-9);
  EXPECT_NEAR(summary.root_mean_square, std::sqrt(7e-6), 1e-9);
  EXPECT_NEAR(summary.percentiles[3].distance, 0.001, 1e-9);
  EXPECT_NEAR(summary.percentiles[5].distance, 0.005, 1e-9);
  double all = 0;
  for (double share : summary.histogram) all += share;
  EXPECT_NEAR(all, 1, 1e-12);
  EXPECT_EQ(summarize({}, {}).found, 0u);
}

TEST(CompareReport, NumbersHaveUnitsAndFilesNames) {
  Comparison comparison;
  comparison.mesh = "part.stl", comparison.volume = "scan.nrrd";
  comparison.voxel = 0.0005, comparison.scale = distance_scale(1);
  comparison.points.resize(2);
  comparison.points[0].area = comparison.points[1].area = 1e-6;
  comparison.deviations = {deviation_of(0.25), deviation_of(0, false)};
  comparison.summary = summarize(comparison.points, comparison.deviations);
  Registration registration;
  registration.mean_square_error = 4e-10, registration.iterations = 7;
  registration.to_volume[3] = glm::dvec4(1, 2, 3, 1);
  comparison.registration = registration;
  const auto json = nlohmann::json::parse(report_json(comparison));
  EXPECT_EQ(json["mesh"]["file"], "part.stl");
  EXPECT_EQ(json["volume"]["voxel_mm"], 0.5);
  EXPECT_NEAR(json["registration"]["root_mean_square_error_mm"].get<double>(), 0.02, 1e-9);
  EXPECT_EQ(json["registration"]["to_volume_rows_m"][7], 2.0);
  EXPECT_NEAR(json["deviation"]["max_mm"].get<double>(), 0.25, 1e-6);
  EXPECT_EQ(json["deviation"]["not_found_share"], 0.5);
  const std::string csv = report_csv(comparison);
  EXPECT_EQ(csv.substr(csv.find('\n') + 1), "0,0,0,1,1,0.25,0,0,0\n0,0,0,1,0,,,,0\n");
  const std::string text = report_text(comparison);
  EXPECT_NE(text.find("part.stl"), std::string::npos);
  EXPECT_NE(text.find("not found on 50.00 %"), std::string::npos);
}

TEST(CompareGlb, ChunksHoldWhatTheJsonSays) {
  SurfaceMesh mesh = box_mesh(dvec3(0), dvec3(2), 1);
  for (dvec3& position : mesh.positions) position += dvec3(1000, 0, 0);
  mesh.positions.push_back(dvec3(NAN));
  mesh.triangles.push_back({0, 1, uint32_t(mesh.positions.size() - 1)});
  weld(mesh);
  const std::vector<vec3> colors(mesh.positions.size(), vec3(0, 0.5f, 1));
  const std::string glb = colored_glb(mesh, colors, "a \"box\"");
  auto word = [&](size_t at) {
    uint32_t value;
    std::memcpy(&value, &glb[at], 4);
    return value;
  };
  ASSERT_EQ(glb.substr(0, 4), "glTF");
  ASSERT_EQ(word(8), glb.size());
  const size_t length = word(12);
  const auto json = nlohmann::json::parse(glb.substr(20, length));
  EXPECT_EQ(json["meshes"][0]["name"], "a \"box\"");
  EXPECT_EQ(json["accessors"][0]["count"], 8);
  EXPECT_EQ(json["accessors"][3]["count"], 36);
  EXPECT_NEAR(json["nodes"][0]["translation"][0].get<double>(), 1000.001, 1e-9);
  EXPECT_NEAR(json["accessors"][0]["max"][0].get<double>(), 0.001, 1e-9);
  const size_t binary = 20 + length + 8;
  EXPECT_EQ(word(20 + length), json["buffers"][0]["byteLength"].get<size_t>());
  EXPECT_EQ(glb.substr(20 + length + 4, 4), std::string("BIN\0", 4));
  const size_t colors_at = binary + json["bufferViews"][2]["byteOffset"].get<size_t>();
  EXPECT_EQ(word(colors_at), 32768u << 16);
  EXPECT_EQ(word(colors_at + 4), 0xffffffffu);
  EXPECT_THROW(colored_glb({}, {}, ""), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
