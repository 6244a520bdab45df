// SPDX-License-Identifier: Apache-2.0
// Multiresolution splatting against the sum over all virtual lights, pixel by pixel.
#include "unit/light/virtual/splat_stage.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

// The Cornell box, lit by a bulb under its ceiling instead of its lamp, without shadows.
SplatStage make_lit_box(int width = 128, int height = 128) {
  Scene scene = make_cornell_box();
  for (Material& m : scene.materials) m.emission = vec3(0);
  PunctualLight light;
  light.position = {0.1f, 0.4f, -0.2f};
  light.intensity = {2, 3, 4};
  scene.lights.push_back(light);
  View view = cornell_view(scene, width, height);
  return {std::move(scene), view};
}

SplatSettings without_shadows() {
  SplatSettings settings;
  settings.visibility = false;
  return settings;
}

}  // namespace

TEST(Splatter, PixelByPixelIsTheSumOverAllVirtualLights) {
  SplatStage stage = make_lit_box(48, 40);
  SplatSettings settings = without_shadows();
  settings.coarsest = 1000;
  stage.draw(settings);
  stage.splat(settings);
  EXPECT_GT(stage.drawn.lights.count, 200);
  EXPECT_EQ(stage.picture.counters.subsplats[0], stage.picture.counters.all_subsplats());
  EXPECT_LT(relative_error(stage), 1e-4);
}

TEST(Splatter, SubsplatsAreCloseToThatSumAtAPartOfItsCost) {
  SplatStage stage = make_lit_box(256, 256);
  SplatSettings settings = without_shadows();
  stage.draw(settings);
  stage.splat(settings);
  EXPECT_LT(relative_error(stage), 0.07);
  EXPECT_LT(stage.picture.counters.all_subsplats(), 256u * 256 / 4);
  EXPECT_GT(stage.picture.counters.subsplats[4], 20u);
  EXPECT_EQ(stage.picture.counters.evaluations,
            stage.picture.counters.all_subsplats() * uint64_t(stage.drawn.lights.count));
}

TEST(Splatter, EveryLitPixelIsOfOneSubsplat) {
  SplatStage stage = make_lit_box(150, 83);
  SplatSettings settings = without_shadows();
  stage.draw(settings);
  stage.splat(settings);
  std::vector<int> covered(150 * 83, 0);
  for (const Subsplat& one : stage.picture.subsplats.all()) {
    int size = 1 << one.level;
    for (int y = one.y * size; y < std::min(83, (one.y + 1) * size); y++)
      for (int x = one.x * size; x < std::min(150, (one.x + 1) * size); x++)
        covered[size_t(y * 150 + x)]++;
  }
  for (int y = 0; y < 83; y++)
    for (int x = 0; x < 150; x++)
      EXPECT_EQ(covered[size_t(y * 150 + x)], stage.lit(x, y) ? 1 : 0) << x << ", " << y;
}

TEST(Splatter, ConvergenceBuysExactnessByMoreSubsplats) {
  SplatStage stage = make_lit_box(256, 256);
  SplatSettings settings = without_shadows();
  stage.draw(settings);
  stage.splat(settings);
  double plain = relative_error(stage);
  uint64_t before = stage.picture.counters.all_subsplats();
  settings.convergence = 0.01f;
  stage.splat(settings);
  EXPECT_LT(relative_error(stage), 0.6 * plain);
  EXPECT_GT(stage.picture.counters.all_subsplats(), before);
  EXPECT_GE(stage.picture.counters.evaluations,
            stage.picture.counters.all_subsplats() * uint64_t(stage.drawn.lights.count));
}

// Same lights, same random numbers: the same bits; and the second picture needs no memory.
TEST(Splatter, PicturesAreRepeatedInTheSameMemory) {
  SplatStage stage = make_lit_box(96, 64);
  SplatSettings settings;
  std::vector<vec3> first;
  std::vector<const void*> memory;
  for (int turn = 0; turn < 3; turn++) {
    stage.draw(settings);
    stage.splat(settings);
    const SplatPicture& picture = stage.picture;
    std::vector<const void*> now = {picture.irradiance.data(),
                                    stage.drawn.lights.groups.data(),
                                    picture.pyramid.cells.data(),
                                    stage.drawn.map.texels.data(),
                                    picture.illumination.levels[0].texels.data(),
                                    picture.shadows.shares.data(),
                                    picture.shadows.owner.data()};
    std::vector<vec3> light(picture.irradiance.begin(), picture.irradiance.end());
    if (turn == 0) first = light;
    if (turn == 1) memory = now;
    EXPECT_EQ(light, first);
    if (turn == 1) continue;
    EXPECT_EQ(now == memory, turn == 2);
  }
}
