// SPDX-License-Identifier: Apache-2.0
// Drawn pictures of who moves, of one sample for dozens of pixels: filtered, and nothing in them
// black or glaring by chance.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int width = 160, height = 120, pixels = width * height;

struct Shown {
  View view;
  Frame frame, truth;
};
// After a second of strolling sideways.
Shown stroll(const Stage& stage, int pixels_a_sample) {
  DrawnVisit visit;
  Shown shown;
  for (int i = 0; i < 30; i++) {
    shown.view = make_view(stage.scene, {0.002 * i, 0.25, 0.6}, 0, 0, 0.7f, width, height);
    visit.step(stage, shown.view, pixels / pixels_a_sample, PictureOf::moving);
  }
  shown.frame = visit.frame;
  shown.truth = stage.truth(shown.view, 256);
  return shown;
}

// Says whether the pixels around show the same object, too.
bool is_inside(const Shown& shown, int x, int y) {
  size_t at = size_t(y * width + x);
  for (size_t other : {at - 1, at + 1, at - size_t(width), at + size_t(width)})
    if (shown.frame.object[other] != shown.frame.object[at]) return false;
  return true;
}

// Counts pixels inside of objects, and those that are brighter or darker than the pixels around by
// more than 15 %.
struct Outliers {
  int outliers = 0, inside = 0;
};
Outliers count_outliers(const Shown& shown) {
  auto light = [&](size_t i) { return luminance(shown.frame.color[i]); };
  Outliers found;
  for (int y = 1; y + 1 < height; y++)
    for (int x = 1; x + 1 < width; x++) {
      if (!is_inside(shown, x, y)) continue;
      size_t at = size_t(y * width + x);
      float around =
          (light(at - 1) + light(at + 1) + light(at - size_t(width)) + light(at + size_t(width))) /
          4;
      found.inside++;
      found.outliers += std::abs(light(at) - around) > 0.15f * around;
    }
  return found;
}

TEST(FewPoints, WallsHaveFewOutliers) {
  Stage stage(make_cornell_box());
  Shown shown = stroll(stage, 64);
  const auto [outliers, inside] = count_outliers(shown);
  EXPECT_GT(inside, pixels / 2);
  EXPECT_LT(outliers, inside / 33);
}

struct Bars {
  double dark = 0, mean = 0, expected = 0;
  int count = 0;
};
Bars look_at_bars(const Stage& stage, const Shown& shown) {
  Bars bars;
  for (size_t i = 0; i < shown.frame.color.size(); i++) {
    uint32_t object = shown.frame.object[i];
    if (object == 0 || stage.scene.objects[object] != "bar") continue;
    float light = luminance(shown.frame.color[i]), truth = luminance(shown.truth.color[i]);
    bars.count++;
    bars.dark += light < 0.3f * truth;
    bars.mean += double(light), bars.expected += double(truth);
  }
  return bars;
}

// Bars a pixel wide, of which most pixels have no sample of their own, and whose light no map
// knows.
TEST(FewPoints, NarrowMetalIsNeitherBlackNorSeveralTimesTooBright) {
  Scene scene = make_barred_box(vec3(0.7f), 0.004f);
  Material gilt = diffuse(vec3(1, 0.7f, 0.3f));
  gilt.metallic = 1, gilt.roughness = 0.3f;
  scene.materials.back() = gilt;
  add_quad(scene, emitter(vec3(8)), {-0.2f, 0.2f, -0.54f}, {0.4f, 0, 0}, {0, 0.3f, 0}, "sky");
  Stage stage(std::move(scene));
  const Bars bars = look_at_bars(stage, stroll(stage, 64));
  EXPECT_GT(bars.count, 500);
  EXPECT_LT(bars.dark, 0.01 * bars.count);
  EXPECT_LT(bars.mean, 2.5 * bars.expected);  // they are darker than what is behind them
}

// The visitor has just come to rest: only one sample in many sees the lamps in a glossy floor.
TEST(FewPoints, GlossyFloorsHaveFewOutliersAtRest) {
  Scene scene = make_cornell_box();
  for (Material& material : scene.materials)
    if (material.emission == vec3(0)) material.roughness = 0.4f, material.specular = 1;
  Stage stage(std::move(scene));
  Shown shown;
  shown.view = make_view(stage.scene, {0, 0.25, 0.6}, 0, -0.25f, 0.7f, width, height);
  DrawnVisit visit;
  for (int i = 0; i < 6; i++) visit.step(stage, shown.view, pixels / 24, PictureOf::still);
  shown.frame = visit.frame;
  const auto [outliers, inside] = count_outliers(shown);
  EXPECT_LT(outliers, inside / 42);
}

}  // namespace
}  // namespace wellspring::test
