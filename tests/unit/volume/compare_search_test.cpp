// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "compare_solids.h"
#include "base/rng.h"
#include "volume/compare/cone_search.h"
#include "volume/compare/lens.h"

namespace wellspring::test {
namespace {

constexpr dvec3 ball_middle{47.3, 48.1, 46.7};

DensityField ball_field(double radius, double noise = 0) {
  Volume volume = solid_volume(
      glm::ivec3(96), [&](dvec3 place) { return glm::distance(place, ball_middle) - radius; });
  volume = blurred(volume, 0.8);
  if (noise == 0) return make_density_field(volume);
  Grid grid = to_grid(volume);
  Rng random(7);
  for (float& value : grid.values)
    value += float(noise * (double(random.next()) / 2147483648.0 - 1));
  return make_density_field(volume_of_floats(grid.size, grid.values));
}

TEST(CompareSearch, ASphereAgainstALargerOneDiffersEverywhereByTheirRadii) {
  const DensityField field = ball_field(30);
  for (double missing : {4.0, 0.6, 0.0, -0.35, -5.0}) {
    const SurfaceMesh mesh = sphere_mesh(ball_middle, 30 + missing, 24);
    const auto points = vertex_points(mesh);
    const auto found = find_deviations(field, points, {});
    double worst = 0, worst_angle = 0;
    for (size_t i = 0; i < points.size(); i++) {
      ASSERT_TRUE(found[i].found) << i;
      worst = std::max(worst, std::abs(found[i].distance / solid_voxel - missing));
      worst_angle = std::max(worst_angle, double(found[i].normal_angle));
    }
    std::printf("sphere %+.2f: worst %.3f voxels, %.2f degrees\n", missing, worst,
                glm::degrees(worst_angle));
    EXPECT_LT(worst, 0.12) << missing;
    EXPECT_LT(glm::degrees(worst_angle), 2) << missing;
  }
}

TEST(CompareSearch, NoiseMovesTheBoundaryLittle) {
  const DensityField field = ball_field(30, 60);  // densities are 0 to 1000
  const auto points = vertex_points(sphere_mesh(ball_middle, 31, 24));
  const auto found = find_deviations(field, points, {});
  double squares = 0;
  for (const Deviation& one : found) {
    ASSERT_TRUE(one.found);
    squares += std::pow(one.distance / solid_voxel - 1, 2);
  }
  EXPECT_LT(std::sqrt(squares / double(found.size())), 0.25);
}

TEST(CompareSearch, ATiltedPlaneDiffersByItsAngleEverywhere) {
  const double tilt = 10.0 * pi / 180;
  const dvec3 normal(std::sin(tilt), 0, std::cos(tilt));
  const DensityField field = make_density_field(blurred(
      solid_volume(glm::ivec3(64), [&](dvec3 place) { return glm::dot(place - 32.0, normal); }),
      1));
  std::vector<SurfacePoint> points;
  for (int x = 12; x <= 52; x += 2)
    for (int y = 12; y <= 52; y += 4)
      points.push_back({dvec3(x, y, 32) * solid_voxel, vec3(0, 0, 1), 0, 1});
  const auto found = find_deviations(field, points, {});
  for (size_t i = 0; i < points.size(); i++) {
    ASSERT_TRUE(found[i].found);
    EXPECT_NEAR(glm::degrees(found[i].normal_angle), 10, 0.8);
    EXPECT_NEAR(found[i].distance, std::tan(tilt) * (points[i].position.x - 32 * solid_voxel),
                0.05 * solid_voxel);
    EXPECT_EQ(found[i].uncertainty, 0);
  }
}

TEST(CompareSearch, VoxelsOfThreeSizesMeasureMetres) {
  Grid grid({40, 60, 20});
  for (int z = 0; z < 20; z++)
    for (int y = 0; y < 60; y++)
      for (int x = 0; x < 40; x++)
        grid.at(x, y, z) = float(
            std::erfc((glm::distance(dvec3(x, y, z) * dvec3(1.5, 1, 3), dvec3(30)) - 20) / 3));
  Volume volume = volume_of_floats(grid.size, grid.values);
  volume.to_metres = glm::translate(dmat4(1), dvec3(5, -7, 2)) *
                     glm::scale(dmat4(1), dvec3(1.5, 1, 3) * solid_voxel);
  const DensityField field = make_density_field(volume);
  EXPECT_DOUBLE_EQ(field.voxel, solid_voxel);
  SurfaceMesh mesh = sphere_mesh(dvec3(30), 21, 12);
  mesh = moved(mesh, glm::translate(dmat4(1), dvec3(5, -7, 2)));
  double sum = 0;
  const auto found = find_deviations(field, vertex_points(mesh), {});
  for (const Deviation& one : found) {
    ASSERT_TRUE(one.found);
    EXPECT_NEAR(one.distance / solid_voxel, 1, 0.5);
    sum += one.distance / solid_voxel;
  }
  EXPECT_NEAR(sum / double(found.size()), 1, 0.1);
}

TEST(CompareSearch, BoundariesThatRiseAreLeftOutOnDemand) {
  // A wall 5 voxels thick: from its outer face the inner one is met first by points within.
  const DensityField field = make_density_field(blurred(
      solid_volume(glm::ivec3(48), [](dvec3 place) { return std::abs(place.z - 24) - 2.5; }), 0.7));
  const std::vector<SurfacePoint> points{{dvec3(24, 24, 22.5) * solid_voxel, vec3(0, 0, 1), 0, 1}};
  ConeSettings settings;
  EXPECT_NEAR(find_deviations(field, points, settings)[0].distance / solid_voxel, 1, 0.1);
  settings.boundary = Boundary::falling;
  EXPECT_NEAR(find_deviations(field, points, settings)[0].distance / solid_voxel, -4, 0.1);
}

TEST(CompareSearch, WhatCannotBeMeasuredIsNotFound) {
  const DensityField field = ball_field(30);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double endless = std::numeric_limits<double>::infinity();
  const vec3 up(0, 0, 1);
  std::vector<SurfacePoint> points{{dvec3(none, 0, 0), up, 0.5f, 1},
                                   {dvec3(endless, 0, 0), up, 0.5f, 1},
                                   {dvec3(0.048), vec3(0), 0.5f, 1},
                                   {dvec3(0.048), vec3(NAN), 0.5f, 1},
                                   {dvec3(1e300, -1e300, 0), up, 0.5f, 1},
                                   {dvec3(100, 0, 0), up, 1.3f, 1},
                                   {dvec3(-1e30), up, 1.3f, 1},
                                   {dvec3(0.048), up, 0, 1}};
  for (const Deviation& one : find_deviations(field, points, {})) {
    EXPECT_FALSE(one.found);
    EXPECT_EQ(one.distance, 0);
  }
  EXPECT_TRUE(find_deviations(field, {}, {}).empty());
}

TEST(CompareSearch, AVolumeOfOneDensityHasNoBoundary) {
  const DensityField field =
      make_density_field(volume_of_floats({2, 1, 3}, std::vector<float>(6, 5.0f)));
  const auto found = find_deviations(field, {{dvec3(0), vec3(1, 0, 0), 1, 1}}, {});
  EXPECT_FALSE(found[0].found);
}

TEST(CompareSearch, WrongVolumesAreRefused) {
  Volume volume = volume_of_floats({2, 2, 2}, std::vector<float>(8, 0.0f));
  volume.to_metres[0] = glm::dvec4(0);
  EXPECT_THROW(make_density_field(volume), std::invalid_argument);
  volume.to_metres[0] = glm::dvec4(NAN, 0, 0, 0);
  EXPECT_THROW(make_density_field(volume), std::invalid_argument);
  EXPECT_THROW(make_density_field(Volume{}), std::invalid_argument);
}

TEST(CompareSearch, ClassesOfDensitiesAreSplitBetweenThem) {
  std::vector<float> values(1000, 10);
  for (size_t i = 0; i < 300; i++) values[i * 3] = 90;
  const DensityField field = make_density_field(volume_of_floats({10, 10, 10}, values));
  EXPECT_NEAR(field.low, 10, 0.1);
  EXPECT_NEAR(field.high, 90, 0.1);
  EXPECT_NEAR(field.split, 50, 0.1);
}

TEST(CompareSearch, SamplesAreTrilinear) {
  Grid grid({5, 4, 3});
  for (int z = 0; z < 3; z++)
    for (int y = 0; y < 4; y++)
      for (int x = 0; x < 5; x++) grid.at(x, y, z) = float(x + 10 * y + 100 * z + x * y * z);
  const DensityField field = make_density_field(volume_of_floats(grid.size, grid.values));
  const vec3 place(1.25f, 2.5f, 0.75f);
  EXPECT_NEAR(sample_density(field, all_lanes(place))[3], 1.25 + 25 + 75 + 1.25 * 2.5 * 0.75, 1e-3);
  EXPECT_EQ(sample_density(field, all_lanes(vec3(-5, 99, -1e30f)))[0], 30);
}

TEST(CompareProfile, ThePeakStandsAtTheGap) {
  const DensityField field = ball_field(30);
  const SurfacePoint point{(ball_middle + dvec3(33, 0, 0)) * solid_voxel, vec3(1, 0, 0), 0, 1};
  const Deviation found = find_deviations(field, {point}, {})[0];
  const RayProfile profile = ray_profile(field, point, found, {});
  ASSERT_EQ(profile.places.size(), 65u);
  size_t steepest = 0;
  for (size_t i = 0; i < profile.slopes.size(); i++)
    if (std::abs(profile.slopes[i]) > std::abs(profile.slopes[steepest])) steepest = i;
  EXPECT_NEAR(profile.places[steepest], profile.boundary, 0.26 * solid_voxel);
  EXPECT_NEAR(profile.boundary / solid_voxel, -3, 0.1);
  EXPECT_LT(profile.slopes[steepest], -profile.threshold);
}

}  // namespace
}  // namespace wellspring::test
