// SPDX-License-Identifier: Apache-2.0
// The bounce of lights that stay as they are comes to the truth, smoothly, and follows when a light
// changes after all.
#include "light/virtual/dynamic_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "frame/frame.h"
#include "light/technique/technique.h"
#include "scenes/dynamic_picture.h"
#include "scenes/scenes.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;

namespace {

DynamicLight lamp(vec3 position, uint32_t id = 1) {
  DynamicLight one;
  one.light.position = position;
  one.light.intensity = vec3(3, 2, 1);
  one.id = id;
  return one;
}

void show_pictures(SettledBounce& settled, const DynamicLights& lights, int pictures) {
  for (int i = 0; i < pictures; i++) {
    DynamicLights from = lights;
    take_settled(settled, from);
  }
}

TEST(SettledBounce, LightsSettleThatStayAsTheyAre) {
  SettledBounce settled;
  DynamicLights from;
  float flicker = 1;
  for (int i = 0; i < 40; i++) {
    DynamicLight changing = lamp({0, 1, 0}, 2);
    changing.light.intensity *= (flicker *= 1.01f);
    from = {lamp({1, 1, 1}), changing};
    take_settled(settled, from);
    if (i == 1) {
      EXPECT_EQ(from.size(), 2u) << "at once";
    }
  }
  ASSERT_EQ(settled.lights.size(), 1u);
  EXPECT_EQ(settled.lights[0].id, 1u);
  ASSERT_EQ(from.size(), 1u);
  EXPECT_EQ(from[0].id, 2u);
}

TEST(SettledBounce, BeginsAnewWhenALightChanges) {
  SettledBounce settled;
  show_pictures(settled, {lamp({1, 1, 1})}, 40);
  ASSERT_FALSE(settled.lights.empty());
  settled.passes = 5;
  DynamicLights moved{lamp({1, 1.001f, 1})};
  take_settled(settled, moved);
  EXPECT_TRUE(settled.lights.empty());
  EXPECT_EQ(moved.size(), 1u);
  EXPECT_EQ(settled.passes, 0);
  EXPECT_FALSE(wants_pass(settled));
  // A light with NaN is never equal to itself.
  show_pictures(settled, {lamp({NAN, 1, 1})}, 40);
  EXPECT_TRUE(settled.lights.empty());
}

TEST(SettledBounce, PassesAreFewOnceThereAreMany) {
  SettledBounce settled;
  int early = 0, late = 0;
  for (int i = 0; i < 3000; i++) {
    show_pictures(settled, {lamp({1, 1, 1})}, 1);
    if (!wants_pass(settled)) continue;
    (settled.passes++ < most_passes ? early : late)++;
  }
  EXPECT_EQ(early, most_passes);
  EXPECT_NEAR(late, (3000 - most_passes * between_passes) / between_late, 3);
}

// The box by a lamp at its ceiling.
struct Box {
  Scene scene = make_cornell_box();
  DynamicLight one = lamp({0.1f, 0.45f, -0.2f});
  View view;
  std::unique_ptr<World> world;
  Lights lights;
  std::unique_ptr<VisibilityPass> visibility;
  DynamicImage image;
  SettledBounce settled;
  Box() {
    for (Material& m : scene.materials) m.emission = vec3(0);
    view = cornell_view(scene, 64, 64);
    world = std::make_unique<World>(scene);
    lights = make_lights(*world);
    visibility = std::make_unique<VisibilityPass>(*world, lights);
    see_surfaces(*visibility, dynamic_light_view(view), image.surfaces);
    settled.lights = {one};
  }
  void pass() {
    add_pass(*world, lights, image.surfaces, dynamic_splat_settings(), settled, image.bounce);
  }
  std::vector<vec3> draw() {
    clear_planes(image.surfaces, image.light);
    add_settled(settled, image.light);
    return draw_dynamic_light(*visibility, image, view);
  }
  // One bounce of `path` with the lamp in the scene.
  std::vector<vec3> trace() const {
    Scene lit = scene;
    lit.lights.push_back(one.light);
    World with(lit);
    Lights its = make_lights(with);
    StillSettings still;
    still.spp = 512;
    still.transport.max_depth = 3;
    auto both = render_still(*find_technique("path"), with, its, view, still).color;
    still.spp = 16;
    const auto direct = render_still(*find_technique("direct"), with, its, view, still).color;
    for (size_t i = 0; i < both.size(); i++) both[i] -= direct[i];
    return both;
  }
};

double difference(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  double sum = 0, level = 0;
  for (size_t i = 0; i < a.size(); i++)
    sum += double(luminance(abs(a[i] - b[i]))), level += double(luminance(b[i]));
  return sum / level;
}

TEST(SettledBounce, ComesToTheTruthAndShadowsAppear) {
  Box box;
  const auto truth = box.trace();
  box.pass();
  const double first = difference(box.draw(), truth);
  while (box.settled.passes < most_passes) box.pass();
  const double last = difference(box.draw(), truth);
  EXPECT_LT(last, 0.12);
  EXPECT_LT(last, 0.6 * first);
}

// The first pass is the bounce that was seen before, and no pass changes a picture by much.
TEST(SettledBounce, PicturesChangeSmoothly) {
  Box box;
  begin_bounce(*box.world, box.lights, box.settled.lights, box.image.surfaces,
               dynamic_splat_settings(), {}, box.image.bounce);
  clear_planes(box.image.surfaces, box.image.light);
  add_bounce(*box.world, box.lights, box.image.surfaces, dynamic_splat_settings(), {},
             box.image.bounce, box.image.light);
  auto before = draw_dynamic_light(*box.visibility, box.image, box.view);
  box.pass();
  auto picture = box.draw();
  EXPECT_EQ(picture, before);
  for (int i = 0; i < 10; i++) {
    before = picture;
    box.pass();
    picture = box.draw();
    EXPECT_LT(difference(picture, before), 0.06) << i;
  }
}

}  // namespace
