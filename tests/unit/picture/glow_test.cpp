// SPDX-License-Identifier: Apache-2.0
// Surfaces that emit light a little here and there and are lit by others, too: screens, dials,
// coals.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int size = 96;

// A grey board under an even sky; in stripes four texels wide it emits light not at all, hardly (as
// what is left of black in a compressed picture), and brightly.
Scene make_board() {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(1);
  Image image{.width = 32, .height = 32};
  constexpr uint8_t levels[] = {0, 2, 0, 255};
  for (int i = 0; i < 32 * 32; i++)
    for (int c = 0; c < 4; c++) image.texels8.push_back(c == 3 ? 255 : levels[i / 4 % 4]);
  Material board = diffuse(vec3(0.5f));
  board.emission = vec3(2, 1, 0.5f);
  board.emission_texture.texture = add_texture(scene, image);
  add_wall(scene, board, -4, 1, "board");
  return scene;
}

struct Mean {
  vec3 shown{0}, wanted{0};
  float worst = 0;  // largest error of a pixel's channel
};
// Over pixels of the stripe of that number, away from its edges.
Mean compare(const Frame& frame, const Frame& truth, const View& view, int stripe) {
  Mean mean;
  int count = 0;
  for (int y = 0; y < size; y++)
    for (int x = 0; x < size; x++) {
      vec3 ray = view_ray(view, float(x) + 0.5f, float(y) + 0.5f).direction;
      vec2 at = vec2(ray) * (-4 / ray.z) * 4.0f + 4.0f;  // stripes
      float within = at.x - std::floor(at.x);
      bool on = at.x > 0 && at.x < 8 && at.y > 0.5f && at.y < 7.5f;
      if (!on || int(at.x) % 4 != stripe || within < 0.35f || within > 0.65f) continue;
      size_t i = size_t(y * size + x);
      mean.shown += frame.color[i], mean.wanted += truth.color[i];
      vec3 off = abs(frame.color[i] - truth.color[i]);
      mean.worst = std::max(mean.worst, std::max(off.x, std::max(off.y, off.z)));
      count++;
    }
  EXPECT_GT(count, 50);
  mean.shown /= float(count), mean.wanted /= float(count);
  return mean;
}

// However little a place emits light, the light that falls on it is not lost, and none counts
// twice.
TEST(Glow, IsAddedToTheLightThatFallsThere) {
  Stage stage(make_board());
  View view = make_view(stage.scene, {0, 0, 0}, 0, 0, 2 * std::atan(0.3f), size, size);
  Frame truth = stage.truth(view, 64);
  for (PictureOf kind : {PictureOf::moving, PictureOf::still}) {
    DrawnVisit visit;
    for (int i = 0; i < 24; i++) visit.step(stage, view, size * size / 4, kind);
    for (int stripe = 0; stripe < 4; stripe++) {
      Mean mean = compare(visit.frame, truth, view, stripe);
      float of = mean.wanted.x;
      EXPECT_LT(glm::length(mean.shown - mean.wanted), 0.03f * of)
          << "picture " << int(kind) << ", stripe " << stripe << ": " << mean.shown.x << ", "
          << mean.shown.y << ", " << mean.shown.z << " for " << mean.wanted.x << ", "
          << mean.wanted.y << ", " << mean.wanted.z;
      EXPECT_LT(mean.worst, 0.15f * of) << "picture " << int(kind) << ", stripe " << stripe;
    }
  }
}

// A lamp's own light goes with the lamp.
TEST(Glow, FollowsTheLampThatIsSwitched) {
  Scene scene = make_board();
  scene.lamps.push_back({"board", {}, {int(scene.materials.size()) - 1}});
  Stage stage(std::move(scene));
  View view = make_view(stage.scene, {0, 0, 0}, 0, 0, 2 * std::atan(0.3f), size, size);
  DrawnVisit visit;
  for (int i = 0; i < 40; i++) visit.step(stage, view, size * size, PictureOf::moving);
  float lit = compare(visit.frame, visit.frame, view, 3).shown.x;
  EXPECT_GT(lit, 2);
  stage.world->set_lamp(0, 0);
  visit.cache.relight([](const RenderCache::Surface&, vec3&, vec3&) { return true; });
  visit.step(stage, view, 0, PictureOf::moving);
  EXPECT_NEAR(compare(visit.frame, visit.frame, view, 3).shown.x, 0.5f, 0.05f);
}

}  // namespace
}  // namespace wellspring::test
