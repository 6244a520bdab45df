// SPDX-License-Identifier: Apache-2.0
// What lies behind is looked and pointed at without turning the back to somebody who listens.
#include <gtest/gtest.h>

#include "avatar/mind/storyteller.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

const Character& whole() {
  static const Character figure = test::load_text(test::whole_figure());
  return figure;
}

vec3 around(float degrees, float distance, float height = 1.6f) {
  return {distance * std::sin(degrees * 1_deg), height, distance * std::cos(degrees * 1_deg)};
}

struct FacingStage {
  Storyteller storyteller{&whole(), mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;

  void tick() {
    input.dt = 1 / 30.0f;
    input.time += 1 / 30.0;
    tick_storyteller(state, storyteller, input, pose, events);
  }
  void run(double seconds) {
    for (double t = 0; t < seconds; t += 1 / 30.0) tick();
  }
  // Greeted before, and told a story now.
  void begin(vec3 listener, bool kiosk, bool humanlike = true) {
    input.humanlike = humanlike;
    input.guests = {{5, listener, vec3(0), kiosk}};
    run(6);
    input.telling = true;
    run(0.5);
  }
  float yaw(const char* joint) const {
    vec3 ahead =
        eval_joint_frame(whole(), pose, find_joint(whole(), joint)).rotation * vec3(0, 0, 1);
    return std::atan2(ahead.x, ahead.z);
  }
  float from_listener(const char* joint) const {
    vec3 head = input.guests[0].head;
    return std::abs(std::remainder(yaw(joint) - std::atan2(head.x, head.z), 2 * pi));
  }
  vec3 hand(bool left) const {
    return eval_joint_frame(whole(), pose,
                            find_joint(whole(), left ? "l_radiocarpal" : "r_radiocarpal"))
        .center;
  }
};

TEST(Facing, WhatIsBehindIsLookedAtOverTheShoulder) {
  for (bool kiosk : {true, false})
    for (float listener : {0.0f, 50.0f, -100.0f, 170.0f})
      for (float behind : {90.0f, 130.0f, 179.9f, 180.0f, -179.9f, -150.0f, -90.0f}) {
        FacingStage stage;
        stage.begin(around(listener, 1.8f), kiosk);
        stage.input.story.look = around(listener + behind, 4);
        float farthest = 0, body = stage.yaw("humanoid_root"), turned = 0;
        for (int i = 0; i < 300; i++) {
          stage.tick();
          farthest = std::max(farthest, stage.from_listener("skullbase"));
          turned =
              std::max(turned, std::abs(std::remainder(stage.yaw("humanoid_root") - body, 2 * pi)));
        }
        EXPECT_LT(farthest, 75_deg) << listener << " " << behind;
        EXPECT_GT(stage.from_listener("skullbase"), 30_deg) << listener << " " << behind;
        EXPECT_LT(turned, 10_deg) << listener << " " << behind;
      }
}

TEST(Facing, EyesGoFurtherThanTheHeadAndNoFurtherThanTheirSockets) {
  for (float side : {-1.0f, 1.0f}) {
    FacingStage stage;
    stage.begin(around(0, 1.8f), true, false);
    stage.input.story.look = around(side * 140, 4);
    stage.run(4);
    const float head = side * stage.yaw("skullbase"), eye = side * stage.yaw("l_eyeball_joint");
    EXPECT_GT(eye, head + 25_deg);
    EXPECT_LT(eye, head + 40_deg);
  }
}

// A place that wavers about straight behind does not make the head swing from side to side.
TEST(Facing, StraightBehindIsOneWayRound) {
  for (float middle : {180.0f, 170.0f, -170.0f}) {
    FacingStage stage;
    stage.begin(around(0, 1.8f), true);
    stage.input.story.look = around(middle, 3);
    stage.run(3);
    const float side = std::copysign(1.0f, stage.yaw("skullbase"));
    for (int i = 0; i < 300; i++) {
      stage.input.story.look = around(middle + (i % 20 < 10 ? 8.0f : -8.0f), 3);
      stage.tick();
      ASSERT_GT(side * stage.yaw("skullbase"), 35_deg) << middle << " " << i;
    }
  }
}

TEST(Facing, TheHandThatIsNearerPointsBackAndOutward) {
  for (float listener : {0.0f, 80.0f})
    for (float behind : {120.0f, 150.0f, 176.0f, 180.0f, -176.0f, -150.0f, -120.0f}) {
      FacingStage stage;
      stage.begin(around(listener, 1.8f), true, false);
      const float heading = stage.yaw("humanoid_root");
      stage.input.story.point = around(heading / 1_deg + behind, 5, 1.3f);
      const bool left = way_round(behind * 1_deg) > 0;
      float ahead = -1;  // farthest before the chest, metres
      for (int i = 0; i < 150; i++) {
        stage.tick();
        vec3 hand = glm::angleAxis(-heading, vec3(0, 1, 0)) * stage.hand(left);
        if (i > 30) ahead = std::max(ahead, hand.z);
      }
      vec3 hand = glm::angleAxis(-heading, vec3(0, 1, 0)) * stage.hand(left);
      EXPECT_LT(hand.z, -0.1f) << listener << " " << behind;
      EXPECT_GT(left ? hand.x : -hand.x, 0.3f) << listener << " " << behind;
      EXPECT_LT(ahead, 0.25f) << listener << " " << behind;
      EXPECT_LT(stage.from_listener("skullbase"), 75_deg);
    }
}

TEST(Facing, FollowsWhoWalksAround) {
  for (bool kiosk : {true, false})
    for (float way : {-1.0f, 1.0f}) {
      FacingStage stage;
      stage.begin(around(0, 2), kiosk);
      stage.input.story.look = around(180, 4);
      for (int i = 0; i < 900; i++) {  // once around in 30 s
        stage.input.guests[0].head = around(way * 0.4f * float(i), 2);
        stage.tick();
        ASSERT_LT(stage.from_listener("skullbase"), 100_deg) << i;
      }
      stage.run(4);
      EXPECT_LT(stage.from_listener("skullbase"), 75_deg);
      EXPECT_LT(stage.from_listener("humanoid_root"), 65_deg);
    }
}

TEST(Facing, WithoutAListenerTheBodyTurns) {
  FacingStage stage;
  stage.run(1);
  stage.input.telling = true;
  stage.input.story.look = around(180, 4);
  stage.run(6);
  EXPECT_GT(std::abs(stage.yaw("humanoid_root")), 100_deg);
}

// A story is told to whoever asked for it from the other end of the hall, too.
TEST(Facing, AStoryIsToldToWhoIsFarOff) {
  FacingStage stage;
  stage.begin(around(100, 12), false);
  stage.run(4);
  EXPECT_LT(stage.from_listener("skullbase"), 30_deg);
  stage.input.telling = false;
  stage.run(3);
  EXPECT_EQ(stage.state.gaze.guest, 0u);
}

}  // namespace
}  // namespace wellspring::test
