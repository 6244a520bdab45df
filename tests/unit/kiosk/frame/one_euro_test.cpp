// SPDX-License-Identifier: Apache-2.0
#include "kiosk/frame/head.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/rng.h"

namespace wellspring::test {
namespace {

TEST(OneEuro, the_first_value_passes) {
  OneEuro f;
  EXPECT_EQ(step_one_euro(f, {}, 3, {1, 2, 3}), vec3(1, 2, 3));
}

// With beta 0 it is the first-order low pass whose step response is known.
TEST(OneEuro, without_beta_a_step_follows_the_exponential) {
  OneEuro f;
  OneEuroSettings settings{0.5f, 0, 1};
  const float step = 0.001f, tau = 1 / (2 * pi * settings.min_cutoff);
  step_one_euro(f, settings, 0, vec3(0));
  for (int i = 1; i <= 2000; i++) {
    vec3 v = step_one_euro(f, settings, i * double(step), vec3(1, 0, 0));
    EXPECT_NEAR(v.x, 1 - std::exp(-float(i) * step / tau), 0.005f);
    EXPECT_EQ(v.y, 0);
  }
}

TEST(OneEuro, rest_is_calmer_and_motion_is_not_later_with_beta) {
  OneEuroSettings calm{0.5f, 0, 1}, quick{0.5f, 4, 1};
  Rng rng(3);
  OneEuro a;
  double raw = 0, filtered = 0;
  for (int i = 0; i < 3000; i++) {
    float noise = rng.uniform() - 0.5f;
    vec3 v = step_one_euro(a, calm, i / 30.0, vec3(noise, 0, 0));
    raw += noise * noise, filtered += v.x * v.x;
  }
  EXPECT_LT(filtered, 0.1 * raw);
  OneEuro b, c;
  vec3 slow{0}, fast{0};
  for (int i = 0; i < 60; i++) {
    vec3 ramp{float(i) / 30, 0, 0};
    slow = step_one_euro(b, calm, i / 30.0, ramp);
    fast = step_one_euro(c, quick, i / 30.0, ramp);
  }
  EXPECT_LT(59.f / 30 - fast.x, 0.08f);
  EXPECT_GT(59.f / 30 - slow.x, 0.25f);
}

TEST(OneEuro, what_is_no_number_or_no_later_changes_nothing) {
  OneEuro f;
  step_one_euro(f, {}, 0, vec3(1));
  step_one_euro(f, {}, 0.1, vec3(2));
  vec3 before = f.value;
  EXPECT_EQ(step_one_euro(f, {}, 0.2, vec3(std::numeric_limits<float>::quiet_NaN())), before);
  EXPECT_EQ(step_one_euro(f, {}, 0.1, vec3(9)), before);
  EXPECT_EQ(step_one_euro(f, {}, 0.05, vec3(9)), before);
}

}  // namespace
}  // namespace wellspring::test
