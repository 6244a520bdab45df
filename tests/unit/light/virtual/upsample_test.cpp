// SPDX-License-Identifier: Apache-2.0
// Coarse light comes back to pixels without crossing edges; refinement by convergence; memory.
#include "unit/light/virtual/splat_stage.h"

using namespace wellspring;

using namespace wellspring::test;

namespace {

constexpr int side = 32;
constexpr float none = std::numeric_limits<float>::infinity();

// 32 x 32 pixels in squares of 16; each square is one subsplat with light of its own.
struct Squares {
  std::vector<float> depth = std::vector<float>(side * side, 1.0f), nx, ny, nz;
  View view;
  SplatSettings settings;
  MinMaxPyramid pyramid;
  IlluminationPyramid light;
  UpsampleRoom room;
  std::vector<vec3> found = std::vector<vec3>(side * side, vec3(-1));

  Squares() {
    nx.assign(side * side, 0), ny.assign(side * side, 0), nz.assign(side * side, 1);
    view.width = view.height = side;
    settings.coarsest = 2;
  }
  void face_aside(int left, int right) {
    for (int i = 0; i < side * side; i++)
      if (i % side >= left && i % side < right) nx[size_t(i)] = 1, nz[size_t(i)] = 0;
  }
  SplatPixels pixels() const {
    SplatPixels pixels;
    pixels.view = view;
    pixels.depth = depth.data(), pixels.nx = nx.data(), pixels.ny = ny.data();
    pixels.nz = nz.data();
    return pixels;
  }
  // `lights`: of the squares, row by row.
  void run(const float (&lights)[4]) {
    int coarsest = coarsest_level(settings, side, side);
    ASSERT_EQ(coarsest, 4);
    make_min_max_pyramid(pixels(), coarsest, pyramid);
    clear_illumination(pyramid, light);
    for (int k = 0; k < 4; k++)
      if (lights[k] >= 0) light.levels[4].at(k % 2, k / 2) = {lights[k], lights[k], lights[k], 1};
    upsample(pixels(), pyramid, settings, light, room, found);
  }
  float at(int x, int y) const { return found[size_t(y * side + x)].x; }
};

}  // namespace

TEST(Upsample, BetweenSquaresOfOneSurfaceLightChangesSmoothly) {
  Squares squares;
  squares.run({0, 1, 0, 1});
  for (int y = 0; y < side; y++) {
    for (int x = 1; x < side; x++) {
      float step = squares.at(x, y) - squares.at(x - 1, y);
      EXPECT_GE(step, -1e-6f);
      EXPECT_LE(step, 0.1f);
    }
    EXPECT_NEAR(squares.at(0, y), 0, 1e-6);
    EXPECT_NEAR(squares.at(side - 1, y), 1, 1e-6);
    EXPECT_NEAR(squares.at(15, y) + squares.at(16, y), 1, 1e-5);
  }
}

// The edge is the border of two squares, so that neither was refined.
TEST(Upsample, LightDoesNotCrossAnEdgeBetweenSquares) {
  Squares squares;
  squares.face_aside(16, side);
  squares.run({0.25f, 1, 0.25f, 1});
  for (int i = 0; i < side * side; i++)
    EXPECT_FLOAT_EQ(squares.at(i % side, i / side), i % side < 16 ? 0.25f : 1.0f);
}

TEST(Upsample, NothingIsPulledFromEmptySquares) {
  Squares squares;
  squares.run({1, -1, 1, 1});
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++) {
      bool empty = x >= 16 && y < 16;
      EXPECT_FLOAT_EQ(squares.at(x, y), empty ? 0.0f : 1.0f) << x << ", " << y;
    }
}

// The picture's halves lie at two depths: each keeps its light; a hole stays dark.
TEST(Upsample, StepsOfDepthAndHolesPartLight) {
  Squares squares;
  for (int i = 0; i < side * side; i++) {
    if (i % side >= 16) squares.depth[size_t(i)] = 2;
    if (i == 5 * side + 5) squares.depth[size_t(i)] = none;
  }
  squares.run({1, 3, 1, 3});
  for (int i = 0; i < side * side; i++)
    EXPECT_FLOAT_EQ(squares.at(i % side, i / side), i == 5 * side + 5 ? 0.0f
                                                    : i % side < 16   ? 1.0f
                                                                      : 3.0f);
}

TEST(Upsample, TheDetailTermDimsWhatFacesAwayFromTheEye) {
  Squares squares;
  squares.settings.detail = 0.5f;
  squares.face_aside(0, side);
  squares.run({1, 1, 1, 1});
  // The eye is at the origin and looks along -Z: normals along +X face it left of the middle.
  EXPECT_NEAR(squares.at(side - 1, 16), 0.5f, 1e-5);
  EXPECT_GT(squares.at(0, 16), 0.6f);
  EXPECT_LT(squares.at(0, 16), 0.9f);
}
