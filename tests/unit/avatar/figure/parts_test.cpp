// SPDX-License-Identifier: Apache-2.0
// Springs, noise, mirror and blinks by their formulas.
#include <gtest/gtest.h>

#include "avatar/body/stance.h"
#include "avatar/face/face.h"
#include "avatar/figure/noise.h"
#include "avatar/figure/spring_bones.h"
#include "avatar/mind/storyteller_io.h"

namespace wellspring::test {
namespace {

TEST(Spring, DoesNotDependOnTheTickRate) {
  Spring coarse, fine;
  settle(coarse, 1, 5, 0.6f);
  for (int i = 0; i < 600; i++) settle(fine, 1, 5, 0.001f);
  EXPECT_NEAR(coarse.value, fine.value, 1e-4f);
  EXPECT_NEAR(coarse.velocity, fine.velocity, 1e-3f);
  // x(t) = 1 - (1 + 5 t) exp(-5 t)
  EXPECT_NEAR(coarse.value, 1 - (1 + 3) * std::exp(-3.0f), 1e-5f);
}

TEST(Spring, NeverOvershootsFromRestAndEndsThere) {
  Spring spring;
  float last = 0;
  for (int i = 0; i < 1000; i++) {
    settle(spring, 1, 7, 0.01f);
    EXPECT_LE(spring.value, 1 + 1e-6f);
    EXPECT_GE(spring.value, last - 1e-6f);
    last = spring.value;
  }
  for (float dt : {0.0f, 1e-9f, 3600.0f, 1e30f}) {
    Spring s{0.3f, 100};
    settle(s, 1, 7, dt);
    EXPECT_TRUE(std::isfinite(s.value) && std::isfinite(s.velocity)) << dt;
    if (dt > 1) EXPECT_EQ(s.value, 1);
  }
}

TEST(Noise, IsSmoothBoundedAndCentred) {
  double sum = 0, largest = 0, steepest = 0;
  float last = smooth_noise(3, 1000);
  for (int i = 1; i <= 100000; i++) {
    float v = smooth_noise(3, 1000 + i * 0.01);
    sum += double(v);
    largest = std::max(largest, double(std::abs(v)));
    steepest = std::max(steepest, double(std::abs(v - last)));
    last = v;
  }
  EXPECT_LT(std::abs(sum / 100000), 0.05);
  EXPECT_LE(largest, 1);
  EXPECT_GT(largest, 0.5);
  EXPECT_LT(steepest, 0.05);
  EXPECT_NE(smooth_noise(1, 10.5), smooth_noise(2, 10.5));
  EXPECT_TRUE(std::isfinite(smooth_noise(1, 1e15)));
}

constexpr float deg = pi / 180;

// Runs the mirror with a step at time 0 and returns the angle at `seconds`.
vec2 mirror_after(vec3 rotation, double seconds, float dt) {
  MirrorState state;
  double now = 0;
  tick_mirror(state, true, rotation, 0, 0);
  while (now < seconds - 1e-9) {
    float step = float(std::min(double(dt), seconds - now));
    now += double(step);
    tick_mirror(state, true, rotation, now, step);
  }
  return state.angle;
}

TEST(Mirror, StepOfThirtyDegreesEndsAtFifteenWithoutOvershoot) {
  vec3 turned(30 * deg, 0, 0);
  EXPECT_EQ(mirror_after(turned, 0.34, 0.02f).x, 0);
  EXPECT_NEAR(mirror_after(turned, mirror_delay + mirror_lag, 0.02f).x / (15 * deg),
              1 - std::exp(-1.0f), 0.01f);
  EXPECT_NEAR(mirror_after(turned, 8, 0.02f).x, 15 * deg, 0.001f);
  float last = 0;
  for (double t = 0; t < 6; t += 0.1) {
    float now = mirror_after(turned, t, 0.033f).x;
    EXPECT_GE(now, last - 1e-6f);
    EXPECT_LE(now, 15 * deg + 1e-6f);
    last = now;
  }
}

TEST(Mirror, DoesNotDependOnTheTickRate) {
  vec3 turned(-0.5f, 0.2f, 0);
  vec2 fine = mirror_after(turned, 1.3, 0.004f), coarse = mirror_after(turned, 1.3, 0.65f);
  EXPECT_NEAR(fine.x, coarse.x, 1e-3f);
  EXPECT_NEAR(fine.y, coarse.y, 1e-3f);
}

TEST(Mirror, DeadZoneLimitsAndAbsence) {
  EXPECT_EQ(mirror_after({3.9f * deg, -3.9f * deg, 0}, 10, 0.1f), vec2(0));
  vec2 far = mirror_after({80 * deg, -80 * deg, 0}, 10, 0.1f);
  EXPECT_NEAR(far.x, 25 * deg, 1e-3f);
  EXPECT_NEAR(far.y, -12 * deg, 1e-3f);
  EXPECT_EQ(mirror_after({NAN, 1, 0}, 5, 0.1f), vec2(0));
  MirrorState state;
  for (int i = 0; i < 100; i++) tick_mirror(state, true, {0.5f, 0, 0}, i * 0.1, 0.1f);
  EXPECT_GT(state.angle.x, 0.2f);
  for (int i = 100; i < 200; i++) tick_mirror(state, false, {0.5f, 0, 0}, i * 0.1, 0.1f);
  EXPECT_NEAR(state.angle.x, 0, 1e-3f);
  tick_mirror(state, true, {0.5f, 0, 0}, 4000, 3600);
  EXPECT_TRUE(std::isfinite(state.angle.x));
}

TEST(Mirror, RestlessHeadAtAHighRateKeepsTheLatestWord) {
  MirrorState state;
  double now = 0;
  for (int i = 0; i < 5000; i++) {
    now += 0.001;
    tick_mirror(state, true, {0.3f + 0.0001f * float(i % 7), 0, 0}, now, 0.001f);
  }
  EXPECT_NEAR(state.angle.x, 0.15f, 0.01f);
  EXPECT_LE(state.count, 64);
}

TEST(Blink, RateDurationAndSpacingOfAQuarterHour) {
  BlinkState state;
  Rng rng(5);
  int blinks = 0, doubles = 0;
  double begun = -1, last_begun = -1, shortest = 1e9, longest = 0;
  bool shut = false, closed = false;
  for (int i = 0; i < 900 * 100; i++) {
    double now = i * 0.01;
    float lids = tick_blink(state, rng, now, true);
    ASSERT_GE(lids, 0);
    ASSERT_LE(lids, 1);
    if (!shut && lids > 0) {
      begun = now;
      if (last_begun >= 0 && begun - last_begun < 0.6) doubles++;
      else if (last_begun >= 0) EXPECT_GT(begun - last_begun, 1.9);
      if (last_begun >= 0) EXPECT_LT(begun - last_begun, 5.1);
      last_begun = begun;
      closed = false;
    }
    closed = closed || lids == 1;
    if (shut && lids == 0) {
      blinks++;
      EXPECT_TRUE(closed) << "a blink closes the eye fully";
      shortest = std::min(shortest, now - begun);
      longest = std::max(longest, now - begun);
    }
    shut = lids > 0;
  }
  EXPECT_GT(blinks / 15.0, 12);
  EXPECT_LT(blinks / 15.0, 25);
  EXPECT_GT(doubles, 5);
  EXPECT_GE(shortest, 0.15);
  EXPECT_LE(longest, 0.25);
}

TEST(Blink, CalmBlinksAreRegularAndPausesAreNotMadeUpFor) {
  BlinkState state;
  Rng rng(5);
  Rng before = rng;
  for (int i = 0; i < 1000; i++) tick_blink(state, rng, i * 0.1, false);
  EXPECT_EQ(rng.state, before.state) << "calm blinks draw no random numbers";
  EXPECT_EQ(state.count, 25);
  tick_blink(state, rng, 1e6, true);
  EXPECT_GT(state.next, 1e6);
}

TEST(Stance, TurnsInStepsWithOneFootOnTheGround) {
  StanceState state;
  double now = 0;
  float left = 0, right = 0;
  for (int i = 0; i < 400; i++) {
    now += 0.02;
    tick_stance(state, true, 1.5f, 0.5f, 0.1f, now, 0.02f);
    bool left_steps = state.foot[0].phase < 1, right_steps = state.foot[1].phase < 1;
    EXPECT_FALSE(left_steps && right_steps);
    if (!left_steps && state.foot[0].lift() == 0 && i > 0) left = state.foot[0].facing();
    (void)right;
    EXPECT_LT(std::abs(state.foot[0].facing() - state.foot[1].facing()), 1.0f)
        << "feet never cross";
  }
  EXPECT_NEAR(state.heading.value, 1.5f, 0.15f);
  EXPECT_NEAR(left, 1.5f, 0.15f);
  for (int i = 0; i < 800; i++) tick_stance(state, true, 0, -1, 2, now += 0.02, 0.02f);
  EXPECT_NEAR(state.heading.value, 0, 0.15f);
}

TEST(Stance, WholeTurnsAreTakenBack) {
  StanceState state;
  double now = 0;
  for (int i = 0; i < 20000; i++) {
    now += 0.05;
    tick_stance(state, true, state.heading.value + 1, 0.5f, 0.1f, now, 0.05f);
    ASSERT_LT(std::abs(state.heading.value), 8);
  }
}

}  // namespace
}  // namespace wellspring::test
