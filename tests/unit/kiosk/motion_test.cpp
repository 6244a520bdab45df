// SPDX-License-Identifier: Apache-2.0
#include "kiosk/people.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kiosk/figure.h"

namespace wellspring::test {
namespace {

constexpr double rate = 15;

GrayFrame room(double time, float light = 1, float noise = 2.5f, bool visitor = false,
               float x = 0) {
  FigurePose pose{.visible = visitor, .position = {x, 0.03f, 0.9f}};
  return draw_figure({320, 240, light, noise, 5}, {}, pose, time);
}

TEST(Motion, noise_alone_is_not_motion) {
  for (float noise : {1.f, 5.f}) {
    MotionWatch watch;
    for (int i = 0; i < 60; i++) {
      Motion m = watch.step(room(i / rate, 1, noise));
      EXPECT_FALSE(m.moving) << "frame " << i << " noise " << noise << " share " << m.share;
    }
  }
}

TEST(Motion, a_lamp_that_fades_or_switches_is_not_motion) {
  MotionWatch fade, step;
  for (int i = 0; i < 90; i++) {
    float level = 1 - 0.5f * float(std::clamp((i - 30) / 30.0, 0.0, 1.0));
    EXPECT_FALSE(fade.step(room(i / rate, level)).moving) << "fading, frame " << i;
    EXPECT_FALSE(step.step(room(i / rate, i < 30 ? 1.f : 0.6f)).moving) << "switched, frame " << i;
  }
}

TEST(Motion, somebody_walking_is_motion_and_the_zone_is_where_they_are) {
  MotionWatch watch;
  for (int i = 0; i < 30; i++) watch.step(room(i / rate));
  int moving = 0;
  for (int i = 30; i < 45; i++) {
    float x = 0.4f - 0.04f * float(i - 30);  // from the image's left to its middle
    Motion m = watch.step(room(i / rate, 1, 2.5f, true, x));
    moving += m.moving;
    if (i < 40) continue;
    ASSERT_FALSE(m.zones.empty());
    const float u = 160 - x / 0.9f * focal_length({}, 320, 240);
    EXPECT_LT(m.zones[0].x, u);
    EXPECT_GT(m.zones[0].x + m.zones[0].width, u);
  }
  EXPECT_GE(moving, 14);
}

TEST(Motion, what_was_left_behind_stops_being_motion) {
  MotionWatch watch;
  for (int i = 0; i < 30; i++) watch.step(room(i / rate));
  bool began = false;
  for (int i = 30; i < 75; i++) {
    Motion m =
        watch.step(room(i / rate, 1, 2.5f, true, 0));  // appears and then stands like a statue
    began |= m.moving;
    if (i > 50) {
      EXPECT_FALSE(m.moving) << "frame " << i;
    }
  }
  EXPECT_TRUE(began);
}

TEST(Motion, frames_of_any_size_are_taken) {
  MotionWatch watch;
  EXPECT_FALSE(watch.step({}).moving);
  GrayFrame tiny{0, 8, 8, std::vector<uint8_t>(64, 10)};
  EXPECT_FALSE(watch.step(tiny).moving);
  GrayFrame wide{1, 1000, 16, std::vector<uint8_t>(16000, 10)};
  EXPECT_FALSE(watch.step(wide).moving);
  EXPECT_FALSE(watch.step(room(2)).moving);
}

}  // namespace
}  // namespace wellspring::test
