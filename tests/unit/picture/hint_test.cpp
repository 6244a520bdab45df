// SPDX-License-Identifier: Apache-2.0
// What techniques know of their samples' noise, and what the cache makes of it.
#include <gtest/gtest.h>

#include "judge/flip.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// A picture after five times one sample for 25 pixels. `told`: hints reach the cache.
Frame show(const Stage& stage, const View& view, bool told) {
  DrawnVisit visit;
  visit.technique = "gather";
  for (int i = 0; i < 5; i++) {
    visit.sample(stage, view, view.width * view.height / 25);
    for (Sample& sample : visit.samples)
      if (!told) sample.flags &= uint8_t(~sample_sure);
    visit.cache.remember(view, visit.requests, visit.samples);
    visit.compositor.draw(visit.cache, view, *stage.visibility, visit.frame);
  }
  return visit.frame;
}

// Shadows of a lamp without a size are shadows, not noise; with a sample for five pixels no place
// was seen twice, and only the hint tells.
TEST(Hint, ShadowsOfALampWithoutASizeAreSure) {
  Scene scene = make_cornell_box();
  for (Material& material : scene.materials) material.emission = vec3(0);
  scene.lights.push_back({.position = {0, 0.54f, -0.28f}, .intensity = {0.25f, 0.2f, 0.12f}});
  Stage stage(std::move(scene));
  View view = make_view(stage.scene, {0, 0.275, 0.8}, 0, 0, 0.7f, 160, 120);
  Frame truth = stage.truth(view, 64);
  double told = flip(show(stage, view, true), truth),
         untold = flip(show(stage, view, false), truth);
  EXPECT_LT(told, 0.97 * untold);
}

}  // namespace
}  // namespace wellspring::test
