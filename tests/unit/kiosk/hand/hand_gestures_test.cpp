// SPDX-License-Identifier: Apache-2.0
// What one hand does over time.
#include "kiosk/hand/hand_gestures.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "unit/kiosk/hand/made_hand.h"

namespace wellspring::test {
namespace {

struct Moved {
  HandShape shape;
  vec3 palm{0, 0, 0.6f};
  float clockwise = 0;
};

HandShape shape(HandPose pose, int fingers, bool upright = true) {
  HandShape out;
  out.pose = pose, out.fingers = fingers, out.upright = upright;
  return out;
}
const HandShape open = shape(HandPose::open, 5), fist = shape(HandPose::fist, 0);

std::vector<std::string> spotted(double seconds, double rate,
                                 const std::function<Moved(double)>& move) {
  HandGestures gestures;
  std::vector<std::string> out;
  for (double t = 0; t < seconds; t += 1 / rate) {
    const Moved now = move(t);
    const std::string found = gestures.step(t, now.shape, now.palm, now.clockwise);
    if (!found.empty()) out.push_back(found);
  }
  return out;
}
using Names = std::vector<std::string>;

class HandRates : public testing::TestWithParam<double> {};

TEST_P(HandRates, AnOpenPalmThatIsHeldStops) {
  EXPECT_EQ(spotted(2, GetParam(), [](double) { return Moved{open}; }), Names{"stop"});
}

TEST_P(HandRates, FingersThatAreHeldUpAreADigit) {
  for (int fingers = 1; fingers <= 4; fingers++)
    EXPECT_EQ(
        spotted(2, GetParam(), [&](double) { return Moved{shape(HandPose::other, fingers)}; }),
        Names{std::to_string(fingers)});
}

TEST_P(HandRates, AnOpenHandThatMovesFastSwipes) {
  for (float way : {-1.f, 1.f}) {
    const auto found = spotted(2, GetParam(), [&](double t) {
      Moved now{open};
      now.palm.x = way * 0.45f * float(std::clamp(t - 0.4, 0.0, 0.4) / 0.4);
      now.shape.upright = false;
      return now;
    });
    EXPECT_EQ(found, Names{way < 0 ? "swipe_left" : "swipe_right"});
  }
}

TEST_P(HandRates, AClosedHandTurns) {
  for (float way : {-1.f, 1.f}) {
    const auto found = spotted(2, GetParam(), [&](double t) {
      Moved now{t < 0.5 ? open : fist};
      now.clockwise = way * 0.9f * float(std::clamp(t - 0.6, 0.0, 0.8) / 0.8);
      return now;
    });
    EXPECT_EQ(found, Names{way < 0 ? "turn_left" : "turn_right"});
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, HandRates, testing::Values(5., 15., 30.),
                         [](const auto& info) { return std::to_string(int(info.param)); });

TEST(HandGestures, WhatIsNotHeldIsNothing) {
  // Shown for a moment only, or moved about, or hanging.
  EXPECT_EQ(spotted(0.5, 15, [](double) { return Moved{open}; }), Names{});
  EXPECT_EQ(spotted(3, 15,
                    [](double t) {
                      Moved now{open};
                      now.palm.y = 0.2f * float(std::sin(6 * t));
                      return now;
                    }),
            Names{});
  EXPECT_EQ(spotted(3, 15, [](double) { return Moved{shape(HandPose::open, 5, false)}; }), Names{});
  EXPECT_EQ(spotted(3, 15, [](double) { return Moved{fist}; }), Names{});
}

TEST(HandGestures, TheWayBackIsNoSwipe) {
  const auto found = spotted(1.4, 15, [](double t) {
    Moved now{shape(HandPose::open, 5, false)};
    now.palm.x = 0.4f * float(std::sin(pi * std::clamp((t - 0.2) / 0.8, 0., 1.)));
    return now;
  });
  EXPECT_EQ(found, Names{"swipe_right"});
}

TEST(HandGestures, ASignIsToldAgainAfterItWasAway) {
  const auto found = spotted(
      4, 15, [](double t) { return Moved{t > 1.5 && t < 2.5 ? fist : shape(HandPose::other, 2)}; });
  EXPECT_EQ(found, (Names{"2", "2"}));
}

TEST(HandGestures, AFlickerOfOneFrameKeepsASign) {
  const auto found = spotted(1.2, 15, [](double t) {
    return Moved{std::abs(t - 0.4) < 0.04 ? fist : shape(HandPose::other, 3)};
  });
  EXPECT_EQ(found, Names{"3"});
}

TEST(HandGestures, TimesThatRunBackwardsBeginAnew) {
  HandGestures gestures;
  for (double t = 10; t < 10.5; t += 0.05) EXPECT_EQ(gestures.step(t, open, vec3(0), 0), "");
  EXPECT_EQ(gestures.step(1, open, vec3(0), 0), "");
  std::string last;
  for (double t = 1.05; t < 2; t += 0.05)
    if (const std::string found = gestures.step(t, open, vec3(0), 0); !found.empty()) last = found;
  EXPECT_EQ(last, "stop");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(gestures.step(nan, open, vec3(0), 0), "");
  EXPECT_EQ(gestures.step(3, open, vec3(NAN), 0), "");
}

}  // namespace
}  // namespace wellspring::test
