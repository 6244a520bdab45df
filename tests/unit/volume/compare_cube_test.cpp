// SPDX-License-Identifier: Apache-2.0
// The paper's cube (section 4.1): 12,288 triangles against 256^3 voxels, with a defect that is
// known. Its picture shows a cut along edges at the top; its greatest difference, 8.485 voxels, is
// that of an edge of which 12 voxels are cut off to both sides: 12 / sqrt(2).
#include <gtest/gtest.h>

#include "compare_solids.h"
#include "volume/compare/cone_search.h"
#include "volume/compare/statistics.h"

namespace wellspring::test {
namespace {

constexpr double cube_low = 32, cube_high = 224, cut = 12;

// How far a place lies beyond the plane that cuts the edge of greatest x and greatest y.
double beyond_cut(dvec3 place) {
  return ((place.x - cube_high) + (place.y - cube_high) + cut) / std::sqrt(2.0);
}

struct CutCube {
  DensityField field;
  SurfaceMesh mesh;
  CutCube() : mesh(box_mesh(dvec3(cube_low), dvec3(cube_high), 32)) {
    const Volume volume = solid_volume(glm::ivec3(256), [](dvec3 place) {
      return std::max(box_distance(place, dvec3(cube_low), dvec3(cube_high)), beyond_cut(place));
    });
    field = make_density_field(blurred(volume, 1));
  }
};
const CutCube& cut_cube() {
  static const CutCube cube;
  return cube;
}

// Half a dozen voxels at the cut's two ends meet three planes: their truth is another one.
bool at_ends(dvec3 place) { return std::min(place.z - cube_low, cube_high - place.z) < 6; }

TEST(CompareCube, ItsGreatestDifferenceIsTheCutsDepth) {
  ASSERT_EQ(cut_cube().mesh.triangles.size(), 12288u);
  const auto points = vertex_points(cut_cube().mesh);
  const auto found = find_deviations(cut_cube().field, points, {});
  const DeviationSummary summary = summarize(points, found);
  EXPECT_EQ(summary.found, points.size());
  EXPECT_NEAR(summary.greatest / solid_voxel, 8.485, 0.25);
  EXPECT_GT(summary.least / solid_voxel, -0.25);
  RecordProperty("greatest_voxels", std::to_string(summary.greatest / solid_voxel));
}

TEST(CompareCube, EachDifferenceIsThatOfTheNearestPlaceInTheCone) {
  const auto points = triangle_points(cut_cube().mesh, 2 * solid_voxel, 4'000'000);
  const auto found = find_deviations(cut_cube().field, points, {});
  double truth_sum = 0, found_sum = 0, worst = 0, worst_sound = 0;
  int cut_points = 0;
  for (size_t i = 0; i < points.size(); i++) {
    const dvec3 place = points[i].position / solid_voxel;
    ASSERT_TRUE(found[i].found) << i;
    const double distance = found[i].distance / solid_voxel;
    if (at_ends(place)) continue;
    const double beyond = beyond_cut(place);
    if (beyond < 0.5) {
      if (beyond < -4) worst_sound = std::max(worst_sound, std::abs(distance));
      continue;
    }
    // The plane lies at 45 degrees: the cone of an edge's triangles reaches its nearest place, the
    // axis of the others meets it sqrt(2) times as far away.
    const double truth = points[i].search_angle > 0.7f ? beyond : beyond * std::sqrt(2.0);
    truth_sum += truth, found_sum += distance, cut_points++;
    worst = std::max(worst, std::abs(distance - truth));
  }
  ASSERT_GT(cut_points, 1000);
  std::printf("cube: mean of the cut %.3f, truth %.3f; worst %.3f, elsewhere %.3f voxels\n",
              found_sum / cut_points, truth_sum / cut_points, worst, worst_sound);
  EXPECT_NEAR(found_sum / cut_points, truth_sum / cut_points, 0.1);
  EXPECT_LT(worst, 0.5);
  EXPECT_LT(worst_sound, 0.05);
}

TEST(CompareCube, NothingDiffersAtASoundEdge) {
  // The paper's other tool reports a difference along the vertical edges, where there is none.
  const auto points = vertex_points(cut_cube().mesh);
  const auto found = find_deviations(cut_cube().field, points, {});
  int edge_points = 0;
  for (size_t i = 0; i < points.size(); i++) {
    const dvec3 place = points[i].position / solid_voxel;
    if (place.x != cube_low || place.y != cube_low || at_ends(place)) continue;
    edge_points++;
    EXPECT_NEAR(found[i].distance / solid_voxel, 0, 0.3);
  }
  EXPECT_GT(edge_points, 20);
}

TEST(CompareCube, UncertaintyIsZeroOnPlanesAndMoreAtEdges) {
  const auto points = triangle_points(cut_cube().mesh, 2 * solid_voxel, 4'000'000);
  const auto found = find_deviations(cut_cube().field, points, {});
  double edge_sum = 0;
  int edges = 0;
  for (size_t i = 0; i < points.size(); i++) {
    const dvec3 place = points[i].position / solid_voxel;
    const dvec3 inside = glm::min(place - cube_low, cube_high - place);
    double sides[3] = {inside.x, inside.y, inside.z};
    std::sort(sides, sides + 3);
    if (sides[1] > 20) {
      EXPECT_LT(found[i].uncertainty / solid_voxel, 0.01);
    }
    if (sides[1] < 1) edge_sum += found[i].uncertainty / solid_voxel, edges++;
  }
  ASSERT_GT(edges, 100);
  EXPECT_GT(edge_sum / edges, 0.05);
}

TEST(CompareCube, ConesAreNarrowOnPlanesAndWideAtEdges) {
  for (const SurfacePoint& point : triangle_points(cut_cube().mesh, 1, 1)) {
    const dvec3 inside =
        glm::min(point.position / solid_voxel - cube_low, cube_high - point.position / solid_voxel);
    double sides[3] = {inside.x, inside.y, inside.z};
    std::sort(sides, sides + 3);
    if (sides[1] > 6) EXPECT_EQ(point.search_angle, 0);
    else EXPECT_GT(point.search_angle, 44.9f * pi / 180);
  }
}

}  // namespace
}  // namespace wellspring::test
