// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/load_error.h"
#include "compare_solids.h"
#include "volume/compare/nearest_point.h"
#include "volume/compare/registration.h"
#include "volume/compare/rigid.h"

namespace wellspring::test {
namespace {

// A body that looks like itself from nowhere else: three boxes of different sizes.
constexpr dvec3 part_low[] = {{30, 36, 40}, {70, 52, 46}, {36, 40, 56}};
constexpr dvec3 part_high[] = {{90, 64, 56}, {82, 84, 52}, {48, 48, 76}};

double body_distance(dvec3 place) {
  double nearest = 1e9;
  for (int i = 0; i < 3; i++)
    nearest = std::min(nearest, box_distance(place, part_low[i], part_high[i]));
  return nearest;
}

SurfaceMesh body_mesh() {
  // Faces within the body pull at nothing: trimming leaves them out.
  SurfaceMesh mesh;
  for (int i = 0; i < 3; i++) {
    const SurfaceMesh part = box_mesh(part_low[i], part_high[i], 6);
    for (uvec3 triangle : part.triangles)
      mesh.triangles.push_back(triangle + uint32_t(mesh.positions.size()));
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  }
  weld(mesh);
  return mesh;
}

const DensityField& body_field() {
  static const DensityField field =
      make_density_field(blurred(solid_volume({120, 120, 110}, body_distance), 0.8));
  return field;
}

dmat4 rigid_move(dvec3 axis, double degrees, dvec3 shift_mm) {
  return glm::translate(dmat4(1), shift_mm / 1000.0) *
         glm::rotate(dmat4(1), glm::radians(degrees), glm::normalize(axis));
}

// The farthest that a corner of the body lands from its place, in voxels.
double landing_error(const dmat4& move, const dmat4& truth) {
  double worst = 0;
  for (int corner = 0; corner < 8; corner++) {
    const dvec3 place = dvec3(corner & 1 ? 90 : 30, corner & 2 ? 84 : 36, corner & 4 ? 76 : 40);
    const glm::dvec4 at(place * solid_voxel, 1);
    worst = std::max(worst, glm::distance(dvec3(move * at), dvec3(truth * at)) / solid_voxel);
  }
  return worst;
}

TEST(CompareRegistration, AKnownMoveIsFoundWithoutControlPoints) {
  for (const auto& [axis, degrees, shift] :
       {std::tuple{dvec3(1, 2, -1), 160.0, dvec3(300, -50, 20)},
        std::tuple{dvec3(0, 0, 1), 90.0, dvec3(0, 0, 1000)},
        std::tuple{dvec3(-3, 1, 1), 37.0, dvec3(-20, 10, 5)}}) {
    const dmat4 away = rigid_move(axis, degrees, shift);
    const Registration found = register_surface(moved(body_mesh(), away), body_field(), {}, {});
    const double error = landing_error(found.to_volume * away, dmat4(1));
    std::printf("registration: %s, %d iterations, rms %.4f mm, off by %.4f voxels\n",
                found.start.c_str(), found.iterations, 1000 * std::sqrt(found.mean_square_error),
                error);
    EXPECT_LT(error, 0.1);
    EXPECT_LT(std::sqrt(found.mean_square_error), 0.05 * solid_voxel);
    EXPECT_GT(found.iterations, 0);
    EXPECT_EQ(found.start, "principal axes");
  }
}

TEST(CompareRegistration, RoughControlPointsSuffice) {
  const dmat4 away = rigid_move({1, 1, 0}, 75, {40, 10, -30});
  std::vector<ControlPair> pairs;
  int i = 0;
  for (dvec3 corner : {part_low[0], part_high[0], part_high[1], part_high[2]}) {
    const dvec3 place = corner * solid_voxel;
    const dvec3 slip = dvec3(i % 2 ? 2 : -2, i / 2 ? -1 : 2, 1) * solid_voxel;
    pairs.push_back({dvec3(away * glm::dvec4(place, 1)), place + slip});
    i++;
  }
  const Registration found = register_surface(moved(body_mesh(), away), body_field(), pairs, {});
  EXPECT_EQ(found.start, "control points");
  EXPECT_LT(landing_error(found.to_volume * away, dmat4(1)), 0.1);
}

TEST(CompareRegistration, AFrameThatFitsStays) {
  const Registration found = register_surface(body_mesh(), body_field(), {}, {});
  EXPECT_LT(landing_error(found.to_volume, dmat4(1)), 0.05);
}

TEST(CompareRegistration, ASurfaceTooLargeEverywhereStaysInTheMiddle) {
  const dvec3 middle(31.2, 32.4, 30.9);
  const DensityField field = make_density_field(blurred(
      solid_volume(glm::ivec3(64), [&](dvec3 place) { return glm::distance(place, middle) - 20; }),
      0.8));
  const Registration found =
      register_surface(sphere_mesh(middle + dvec3(0.5, 0, -1), 21, 12), field, {}, {});
  const dvec3 there(found.to_volume * glm::dvec4((middle + dvec3(0.5, 0, -1)) * solid_voxel, 1));
  EXPECT_LT(glm::distance(there / solid_voxel, middle), 0.05);
}

TEST(CompareRegistration, NothingToGoByIsSaid) {
  const DensityField flat =
      make_density_field(volume_of_floats({4, 4, 4}, std::vector<float>(64, 1.0f)));
  EXPECT_THROW(register_surface(body_mesh(), flat, {}, {}), std::invalid_argument);
  EXPECT_THROW(register_surface({}, body_field(), {}, {}), std::invalid_argument);
  SurfaceMesh degenerate{{dvec3(0), dvec3(0), dvec3(NAN)}, {}, {{0, 1, 2}, {0, 1, 1}}};
  weld(degenerate);
  EXPECT_THROW(register_surface(degenerate, body_field(), {}, {}), std::invalid_argument);
}

TEST(CompareRegistration, CoordinatesBeyondAllMeasureFindNothing) {
  for (double size : {1e160, 1e305}) {
    SurfaceMesh mesh = body_mesh();
    for (dvec3& position : mesh.positions) position *= size;
    weld(mesh);
    try {
      EXPECT_EQ(register_surface(mesh, body_field(), {}, {}).found_share, 0) << size;
    } catch (const std::invalid_argument&) {
      EXPECT_GT(size, 1e100);  // areas that are not finite are none
    }
  }
}

TEST(CompareRegistration, HornsMoveLeadsPointsToPoints) {
  const std::vector<dvec3> from{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  for (double degrees : {0.0, 1.0, 90.0, 179.9, 180.0}) {
    const dmat4 truth = rigid_move({1, -2, 0.5}, degrees, {1e6, -2e6, 5e5});
    std::vector<dvec3> to;
    for (dvec3 point : from) to.push_back(dvec3(truth * glm::dvec4(point, 1)));
    const dmat4 move = fit_points(from, to);
    for (size_t i = 0; i < from.size(); i++)
      EXPECT_LT(glm::distance(dvec3(move * glm::dvec4(from[i], 1)), to[i]), 1e-9) << degrees;
    EXPECT_NEAR(glm::determinant(glm::dmat3(move)), 1, 1e-12);
  }
}

TEST(CompareRegistration, EigenvectorsMakeTheMatrix) {
  SymmetricMatrix<3> matrix;
  matrix.at = {{{4, 1, -2}, {1, 3, 0.5}, {-2, 0.5, 7}}};
  const auto found = eigenvectors(matrix);
  EXPECT_GE(found.values[0], found.values[1]);
  EXPECT_GE(found.values[1], found.values[2]);
  for (size_t i = 0; i < 3; i++)
    for (size_t row = 0; row < 3; row++) {
      double sum = 0;
      for (size_t k = 0; k < 3; k++) sum += matrix.at[row][k] * found.vectors[i][k];
      EXPECT_NEAR(sum, found.values[i] * found.vectors[i][row], 1e-12);
    }
}

TEST(CompareRegistration, TheTreeFindsTheNearest) {
  std::vector<dvec3> points;
  uint32_t state = 1;
  auto next = [&] { return double((state = state * 1664525 + 1013904223) >> 8) / (1 << 24); };
  for (int i = 0; i < 700; i++) points.push_back({next(), next(), i % 3 ? next() : 0.5});
  const PointTree tree(points);
  for (int i = 0; i < 200; i++) {
    const dvec3 from{next() * 2 - 0.5, next(), next()};
    double nearest = 1e9;
    for (dvec3 point : points) nearest = std::min(nearest, glm::distance(point, from));
    EXPECT_EQ(glm::distance(tree.points()[tree.nearest(from)], from), nearest);
  }
}

TEST(CompareRegistration, ControlPairsAreRead) {
  const std::string file = "/tmp/wellspring_pairs_" + std::to_string(getpid()) + ".json";
  auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_control_pairs(file);
  };
  auto pair = [](const char* a, const char* b) {
    return std::string("{\"surface_m\": ") + a + ", \"volume_m\": " + b + "}";
  };
  const std::string first = pair("[0,0,0]", "[1,0,0]"), second = pair("[0,1,0]", "[1,1,0]"),
                    third = pair("[0,0,2.5]", "[1,0,2.5]"), line = pair("[0,2,0]", "[1,2,0]");
  const auto good = read("{\"pairs\": [" + first + "," + second + "," + third + "]}");
  ASSERT_EQ(good.size(), 3u);
  EXPECT_EQ(good[2].volume, dvec3(1, 0, 2.5));
  for (const std::string& bad :
       {"{\"pairs\": [" + first + "," + second + "]}",
        "{\"pairs\": [" + first + "," + second + "," + line + "]}",
        "{\"pairs\": [" + first + "," + first + "," + first + "]}", std::string("{}"),
        "{\"pairs\": [" + first + "," + second + ",{\"surface_m\": [1,2]}]}", std::string("[")})
    EXPECT_THROW(read(bad), LoadError) << bad;
  unlink(file.c_str());
}

}  // namespace
}  // namespace wellspring::test
