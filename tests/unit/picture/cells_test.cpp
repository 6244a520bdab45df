// SPDX-License-Identifier: Apache-2.0
#include "picture/cells/cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/rng.h"

namespace wellspring::test {
namespace {

constexpr int width = 96, height = 64;

View front_view() {
  return View{.right = {1, 0, 0},
              .up = {0, 1, 0},
              .forward = {0, 0, -1},
              .tan_half_fov = 0.5f,
              .width = width * cell_size,
              .height = height * cell_size};
}

// A wall two metres off, of which one cell in six has a point: one sample, as a renderer gives it
// that finds the only lamp by chance. Its mean is 1.
struct SparseWall {
  View view = front_view();
  Scratch scratch;
  Cells cells;
  explicit SparseWall(uint64_t seed) {
    scratch.start(cells_bytes(view.width, view.height));
    take_cells(cells, view.width, view.height, scratch);
    Rng rng(seed);
    auto chance = [&] { return float(rng.next()) * 0x1p-32f; };
    for (int y = 0; y < cells.height; y++)
      for (int x = 0; x < cells.width; x++) {
        size_t i = size_t(cells.index(x, y));
        bool known = chance() < 1 / 6.0f;
        float light = chance() < 0.25f ? 3.7f : 0.1f;
        for (size_t k = 0; k < 3; k++) {
          cells.albedo[k][i] = known ? 0.5f : 0;
          cells.smooth[k][i] = known ? light : 0;
          cells.rest[k][i] = 0;
          cells.normal[k][i] = known && k == 2 ? 1 : 0;
          cells.plane[k][i] = known && k == 2 ? 0.5f : 0;
        }
        cells.depth[i] = known ? 2 : 0;
        cells.samples[i] = cells.points[i] = known;
        cells.sum[i] = known ? light : 0;
        cells.sum2[i] = known ? light * light : 0;
        cells.prior_weight[i] = cells.rest_sum[i] = cells.rest_sum2[i] = 0;
        cells.rest_noise[i] = cells.rest_known[i] = 0;
        cells.object[i] = known ? 7 : no_object;
      }
  }
  // Root mean square of the known cells' deviation from 1.
  double error() const {
    double sum = 0, count = 0;
    for (int y = 8; y < cells.height - 8; y++)
      for (int x = 8; x < cells.width - 8; x++) {
        size_t i = size_t(cells.index(x, y));
        if (cells.object[i] == no_object) continue;
        double off = double(cells.smooth[0][i]) - 1;
        sum += off * off, count++;
      }
    return std::sqrt(sum / count);
  }
};

TEST(Cells, OneDarkSampleFarFromOthersIsNotSureOfItself) {
  for (uint64_t seed : {1u, 2u, 3u}) {
    SparseWall wall(seed);
    double before = wall.error();
    ASSERT_TRUE(fill_cells(wall.view, wall.cells));
    filter_cells(wall.view, wall.cells);
    // Some 130 samples lie within reach of the steps; were all weighed alike, a ninth would be
    // left.
    EXPECT_LT(wall.error(), before / 4) << "seed " << seed;
  }
}

TEST(Cells, FilteringTakesNoiseFromWhatIsFilledIn) {
  SparseWall wall(4);
  ASSERT_TRUE(fill_cells(wall.view, wall.cells));
  double filled = wall.error();
  filter_cells(wall.view, wall.cells);
  EXPECT_LT(wall.error(), filled / 3);
}

// A floor runs away from the viewer: each hole is filled at the floor's depth, not at that of the
// nearest known cell.
TEST(Cells, HolesLieInThePlaneAround) {
  SparseWall wall(6);
  Cells& cells = wall.cells;
  PixelRays rays(wall.view);
  vec3 up = normalize(vec3(0, 1, 0.02f));  // in the viewer's axes: right, up, forward
  vec3 plane = -up / 1.6f;                 // 1.6 m below the eye
  auto inverse_depth = [&](int x, int y) {
    return dot(plane, vec3(rays.x((float(x) + 0.5f) * cell_size),
                           rays.y((float(y) + 0.5f) * cell_size), 1));
  };
  std::vector<uint8_t> known(cells.object.size());
  int first = height / 2 + 6;  // rows below the horizon
  for (int y = 0; y < cells.height; y++)
    for (int x = 0; x < cells.width; x++) {
      size_t i = size_t(cells.index(x, y));
      if (y < first) cells.object[i] = no_object, cells.samples[i] = 0;
      if (cells.object[i] == no_object) continue;
      known[i] = 1;
      for (size_t k = 0; k < 3; k++)
        cells.normal[k][i] = up[int(k)], cells.plane[k][i] = plane[int(k)];
      cells.depth[i] = 1 / inverse_depth(x, y);
    }
  ASSERT_TRUE(fill_cells(wall.view, cells));
  for (int y = first + 4; y < cells.height; y++)
    for (int x = 0; x < cells.width; x++) {
      size_t i = size_t(cells.index(x, y));
      ASSERT_NEAR(cells.depth[i] * inverse_depth(x, y), 1, 1e-3)
          << x << ", " << y << (known[i] ? " known" : "");
    }
}

// Half of the wall lies in a shadow that each cell has seen many times: no light may reach into it.
TEST(Cells, AnEdgeThatManySamplesKnowStays) {
  SparseWall wall(5);
  Cells& cells = wall.cells;
  for (int y = 0; y < cells.height; y++)
    for (int x = 0; x < cells.width; x++) {
      size_t i = size_t(cells.index(x, y));
      float light = x < width / 2 ? 1 : 0.05f;
      cells.object[i] = 7, cells.depth[i] = 2;
      cells.normal[2][i] = 1, cells.plane[2][i] = 0.5f;
      for (size_t k = 0; k < 3; k++) cells.smooth[k][i] = light;
      cells.points[i] = 16, cells.samples[i] = 160;
      cells.sum[i] = 160 * light;
      cells.sum2[i] = 160 * light * light * 1.02f;
    }
  filter_cells(wall.view, cells);
  for (int y = 0; y < cells.height; y++) {
    EXPECT_GT(cells.smooth[0][size_t(cells.index(width / 2 - 2, y))], 0.9f);
    EXPECT_LT(cells.smooth[0][size_t(cells.index(width / 2 + 1, y))], 0.1f);
  }
}

}  // namespace
}  // namespace wellspring::test
