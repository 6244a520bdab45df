// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>

#include "avatar/body/body.h"
#include "avatar/mind/storyteller.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

constexpr float deg = pi / 180;

struct Stage {
  Character character = test::load_text(test::whole_figure());
  Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;

  void tick(float dt) {
    input.dt = dt;
    input.time += double(dt);
    tick_storyteller(state, storyteller, input, pose, events);
  }
  void run(double seconds, float dt = 1 / 30.0f) {
    for (double t = 0; t < seconds; t += double(dt)) tick(dt);
  }
  JointFrame frame(const char* joint) const {
    return eval_joint_frame(character, pose, find_joint(character, joint));
  }
  float displacer(const char* name) const {
    return pose.displacers[size_t(find_displacer(character, name))];
  }
  bool finite() const {
    if (!is_finite(pose.translation)) return false;
    for (quat q : pose.rotations)
      if (!(std::abs(glm::length(q) - 1) < 1e-3f)) return false;
    for (float w : pose.displacers)
      if (!(w >= 0 && w <= 1.5f)) return false;
    return true;
  }
};

float angle_between(vec3 a, vec3 b) {
  return std::acos(std::clamp(dot(normalize(a), normalize(b)), -1.0f, 1.0f));
}

// Returns how far an eye looks past a point of humanoid space.
float eye_error(const Stage& stage, const char* eye, vec3 target) {
  JointFrame frame = stage.frame(eye);
  return angle_between(frame.rotation * vec3(0, 0, 1), target - frame.center);
}

TEST(Gaze, BothEyesReachAGuestWithinTwoDegrees) {
  for (bool humanlike : {false, true})
    for (vec3 place :
         {vec3(0, 1.6f, 1.2f), vec3(0.8f, 1.7f, 1), vec3(-1, 1.2f, 1.5f), vec3(-0.4f, 1.9f, 0.9f),
          vec3(2, 1.6f, -0.5f), vec3(0.1f, 1.55f, 0.6f), vec3(-0.3f, 1.6f, -2)}) {
      Stage stage;
      stage.input.humanlike = humanlike;
      stage.input.guests = {{5, place, vec3(0), true}};
      stage.run(8);
      for (int i = 0; i < 100; i++) {
        stage.tick(1 / 30.0f);
        EXPECT_LT(eye_error(stage, "l_eyeball_joint", place), 2 * deg) << place.x << " " << place.z;
        EXPECT_LT(eye_error(stage, "r_eyeball_joint", place), 2 * deg) << place.x << " " << place.z;
      }
      StorytellerGaze gaze = eval_gaze(stage.state, stage.storyteller, stage.pose);
      EXPECT_EQ(gaze.guest, 5u);
      EXPECT_EQ(gaze.target, place);
    }
}

TEST(Gaze, EyesLeadTheHeadAndTheHeadLeadsTheBody) {
  Stage stage;
  stage.input.humanlike = false;
  stage.run(3);
  stage.input.guests = {{5, {0.9f, 1.6f, 1.0f}, vec3(0), true}};
  vec3 place = stage.input.guests[0].head;
  stage.run(0.2);
  EXPECT_LT(eye_error(stage, "l_eyeball_joint", place), 8 * deg)
      << "the eyes are nearly there after 0.2 s";
  float wanted = std::atan2(0.9f, 1.0f);
  auto yaw = [&](const char* joint) {
    vec3 ahead = stage.frame(joint).rotation * vec3(0, 0, 1);
    return std::atan2(ahead.x, ahead.z);
  };
  EXPECT_LT(yaw("skullbase"), 0.5f * wanted);
  stage.run(0.8);
  EXPECT_GT(yaw("skullbase"), 0.6f * wanted);
  EXPECT_LT(yaw("vt6"), yaw("skullbase"));
}

// Eyes above the floor after eight seconds with somebody there.
float eye_height(vec3 guest) {
  Stage stage;
  stage.input.humanlike = false;
  stage.input.guests = {{5, guest, vec3(0), true}};
  stage.run(8);
  EXPECT_LT(eye_error(stage, "l_eyeball_joint", guest), 2 * deg);
  return stage.frame("l_eyeball_joint").center.y;
}

TEST(Bow, MeetsWhoIsLowAndNear) {
  const float upright = eye_height({0, 1.6f, 1.2f}), child = eye_height({0, 1.0f, 1.2f});
  EXPECT_LT(child, upright - 0.12f);
  EXPECT_GT(child, upright - 0.4f) << "it does not go down on its knees";
  EXPECT_NEAR(eye_height({0, 1.0f, 4.5f}), upright, 0.02f) << "not to somebody far off";
  EXPECT_NEAR(eye_height({0, 1.9f, 1.2f}), upright, 0.02f);
  const float seated = eye_height({0, 1.25f, 1.2f});
  EXPECT_LT(seated, upright - 0.03f);
  EXPECT_GT(seated, child);
}

TEST(Gaze, WorksInAnyPlacement) {
  Stage stage;
  stage.storyteller.placement =
      glm::rotate(glm::translate(mat4(1), vec3(10, 2, -5)), 2.0f, vec3(0, 1, 0));
  vec3 here(0.3f, 1.6f, 1.3f), world(stage.storyteller.placement * vec4(here, 1));
  stage.input.guests = {{5, world, vec3(0), true}};
  stage.run(6);
  EXPECT_LT(eye_error(stage, "l_eyeball_joint", here), 2 * deg);
  EXPECT_LT(glm::length(eval_gaze(stage.state, stage.storyteller, stage.pose).target - world),
            1e-3f);
}

TEST(Gaze, KioskGuestsBeforeRemoteOnesAndOnlyNearOnes) {
  Stage stage;
  stage.input.humanlike = false;
  stage.input.guests = {{1, {0, 1.6f, 1}, vec3(0), false}, {2, {1, 1.6f, 2}, vec3(0), true}};
  stage.run(3);
  EXPECT_EQ(eval_gaze(stage.state, stage.storyteller, stage.pose).guest, 2u);
  stage.input.guests = {{1, {0, 1.6f, 7.5f}, vec3(0), false}};
  stage.run(12);
  EXPECT_EQ(eval_gaze(stage.state, stage.storyteller, stage.pose).guest, 1u);
  stage.input.guests[0].head.z = 9;
  stage.run(1);
  EXPECT_EQ(eval_gaze(stage.state, stage.storyteller, stage.pose).guest, 0u);
}

TEST(Gaze, TwoGuestsAtTheSameDistanceDoNotMakeItWaver) {
  Stage stage;
  stage.input.humanlike = false;
  int changes = 0;
  uint32_t last = 0;
  for (int i = 0; i < 600; i++) {
    float jitter = i % 2 ? 0.05f : -0.05f;
    stage.input.guests = {{1, {0.5f, 1.6f, 1.2f + jitter}, vec3(0), true},
                          {2, {-0.5f, 1.6f, 1.2f - jitter}, vec3(0), true}};
    stage.tick(1 / 30.0f);
    uint32_t now = eval_gaze(stage.state, stage.storyteller, stage.pose).guest;
    changes += now != last;
    last = now;
  }
  EXPECT_EQ(changes, 1);
}

TEST(Gaze, FigureWithoutEyesTurnsItsHead) {
  Character character =
      test::load_text(test::x3d("<HAnimHumanoid><HAnimJoint name='HumanoidRoot' "
                                "containerField='skeleton' center='0 0.9 0'><HAnimJoint name='vl5' "
                                "center='0 1 0'><HAnimJoint name='skullbase' center='0 1.5 "
                                "0'/></HAnimJoint></HAnimJoint></HAnimHumanoid>"));
  Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  input.humanlike = false;
  input.guests = {{1, {0.4f, 1.3f, 1.5f}, vec3(0), true}};
  input.dt = 1 / 30.0f;
  for (int i = 0; i < 300; i++) tick_storyteller(state, storyteller, input, pose, events);
  StorytellerGaze gaze = eval_gaze(state, storyteller, pose);
  EXPECT_NEAR(gaze.yaw, std::atan2(0.4f, 1.5f), 4 * deg);
  EXPECT_LT(gaze.pitch, -5 * deg);
}

TEST(Mirror, AddsToTheHeadAndLeavesTheEyesOnTheGuest) {
  Stage still, turned;
  for (Stage* stage : {&still, &turned}) {
    stage->input.humanlike = false;
    stage->input.guests = {{5, {0, 1.6f, 1.2f}, vec3(0), true}};
    stage->run(6);
  }
  turned.input.guests[0].rotation = {30 * deg, 0, 0};
  still.run(6);
  turned.run(6);
  auto yaw = [](const Stage& stage) {
    vec3 ahead = stage.frame("skullbase").rotation * vec3(0, 0, 1);
    return std::atan2(ahead.x, ahead.z);
  };
  EXPECT_NEAR(yaw(turned) - yaw(still), 15 * deg, 0.5f * deg);
  EXPECT_LT(eye_error(turned, "l_eyeball_joint", {0, 1.6f, 1.2f}), 2 * deg);
}

TEST(Storyteller, GreetsWithinASecondAndBidsFarewell) {
  Stage stage;
  stage.run(10);
  int greeted = 0, farewelled = 0;
  double when = -1;
  stage.input.guests = {{9, {0.2f, 1.6f, 1.2f}, vec3(0), true}};
  float smile_before = stage.displacer("smile_l");
  for (int i = 0; i < 150; i++) {
    stage.tick(1 / 30.0f);
    if (stage.events.greeted) greeted++, when = i / 30.0;
    if (i == 90) EXPECT_GT(stage.displacer("smile_l"), smile_before + 0.2f);
  }
  EXPECT_EQ(greeted, 1);
  EXPECT_LE(when, 0.7);
  stage.input.guests.clear();
  for (int i = 0; i < 150; i++) {
    stage.tick(1 / 30.0f);
    farewelled += stage.events.farewelled;
  }
  EXPECT_EQ(farewelled, 1);
}

TEST(Storyteller, WelcomeRaisesTheRightHandAndLowersItAgain) {
  Stage stage;
  stage.input.humanlike = false;
  stage.run(2);
  float hanging = stage.frame("r_radiocarpal").center.y;
  stage.input.guests = {{9, {0, 1.6f, 1.2f}, vec3(0), true}};
  float highest = 0, left_most = 0;
  float left_hanging = stage.frame("l_radiocarpal").center.y;
  for (int i = 0; i < 150; i++) {
    stage.tick(1 / 30.0f);
    highest = std::max(highest, stage.frame("r_radiocarpal").center.y);
    left_most = std::max(left_most, std::abs(stage.frame("l_radiocarpal").center.y - left_hanging));
  }
  EXPECT_GT(highest, hanging + 0.2f);
  EXPECT_LT(left_most, 0.05f);
  EXPECT_NEAR(stage.frame("r_radiocarpal").center.y, hanging, 0.02f);
}

TEST(Storyteller, ArmsHangTheSameInEveryRestPose) {
  // The same arm drawn hanging, at 45 degrees and level: posed, the wrists meet.
  auto make = [](float a) {
    auto at = [&](float along) {
      return std::to_string(0.17f + along * std::sin(a)) + " " +
             std::to_string(1.4f - along * std::cos(a)) + " 0";
    };
    return test::load_text(
        test::x3d("<HAnimHumanoid><HAnimJoint name='humanoid_root' containerField='skeleton'>"
                  "<HAnimJoint name='l_shoulder' center='" +
                  at(0) + "'><HAnimJoint name='l_elbow' center='" + at(0.28f) +
                  "'><HAnimJoint name='l_wrist' center='" + at(0.53f) +
                  "'/></HAnimJoint></HAnimJoint></HAnimJoint></HAnimHumanoid>"));
  };
  vec3 wrist[3];
  int i = 0;
  for (float a : {12 * deg, 45 * deg, 90 * deg}) {
    Character character = make(a);
    Storyteller storyteller{&character, mat4(1)};
    StorytellerState state;
    StorytellerInput input{.humanlike = false};
    StorytellerEvents events;
    Pose pose;
    tick_storyteller(state, storyteller, input, pose, events);
    wrist[i++] = eval_joint_frame(character, pose, find_joint(character, "l_radiocarpal")).center;
  }
  EXPECT_LT(glm::length(wrist[1] - wrist[0]), 0.01f);
  EXPECT_LT(glm::length(wrist[2] - wrist[0]), 0.01f);
  EXPECT_LT(wrist[0].y, 0.9f);
  EXPECT_GT(wrist[0].z, 0.03f) << "elbows are a little bent";
}

TEST(Storyteller, FeetStayPlantedWhileTheWeightShifts) {
  Stage stage;
  stage.run(1);
  vec3 left = stage.frame("l_talocrural").center, right = stage.frame("r_talocrural").center;
  float sway = 0;
  for (int i = 0; i < 3000; i++) {
    stage.tick(1 / 30.0f);
    EXPECT_LT(glm::length(stage.frame("l_talocrural").center - left), 0.002f);
    EXPECT_LT(glm::length(stage.frame("r_talocrural").center - right), 0.002f);
    vec3 toe = stage.frame("l_talocrural").rotation * vec3(0, 0, 1);
    EXPECT_GT(toe.z, 0.9999f);
    sway = std::max(sway, std::abs(stage.pose.translation.x));
  }
  EXPECT_GT(sway, 0.008f);
  EXPECT_LT(sway, 0.05f);
}

TEST(Storyteller, TurnsToAGuestAtItsSideAndBack) {
  Stage stage;
  stage.run(1);
  vec3 ankle = stage.frame("l_talocrural").center;
  stage.input.guests = {{9, {1.5f, 1.6f, -0.2f}, vec3(0), true}};
  stage.run(8);
  vec3 ahead = stage.frame("humanoid_root").rotation * vec3(0, 0, 1);
  EXPECT_GT(std::atan2(ahead.x, ahead.z), 1.0f);
  EXPECT_GT(glm::length(stage.frame("l_talocrural").center - ankle), 0.03f);
  stage.input.guests.clear();
  stage.run(30);
  ahead = stage.frame("humanoid_root").rotation * vec3(0, 0, 1);
  EXPECT_LT(std::abs(std::atan2(ahead.x, ahead.z)), 0.3f);
}

TEST(Storyteller, LidsFollowAGazeDown) {
  Stage up, down;
  for (Stage* stage : {&up, &down}) stage->input.humanlike = false;
  up.input.guests = {{1, {0, 2.2f, 0.8f}, vec3(0), true}};
  down.input.guests = {{1, {0, 0.9f, 0.6f}, vec3(0), true}};
  up.run(3);
  down.run(3);
  EXPECT_EQ(up.displacer("blink_l"), 0);
  EXPECT_GT(down.displacer("blink_l"), 0.1f);
  EXPECT_GT(up.displacer("lid_wide"), 0);
}

TEST(Storyteller, MouthMovesOnlyWhileSpeaking) {
  Stage stage;
  float most = 0;
  for (int i = 0; i < 300; i++) {
    stage.tick(1 / 30.0f);
    most = std::max(most, stage.displacer("viseme_aa"));
  }
  EXPECT_EQ(most, 0);
  stage.input.speaking = 1;
  float closed = 0;
  for (int i = 0; i < 300; i++) {
    stage.tick(1 / 30.0f);
    most = std::max(most, stage.displacer("viseme_aa"));
    closed = std::max(closed, stage.displacer("viseme_PP"));
  }
  EXPECT_GT(most, 0.4f);
  EXPECT_GT(closed, 0.4f);
  stage.input.speaking = 0;
  stage.run(1);
  EXPECT_EQ(stage.displacer("viseme_aa"), 0);
}

TEST(Storyteller, AnyTimeStepIsSafe) {
  Stage stage;
  stage.input.guests = {{1, {0.5f, 1.6f, 1}, vec3(0.5f, 0.1f, 0), true}};
  stage.input.speaking = 1;
  for (float dt : {0.0f, 1e-9f, 1 / 60.0f, 3600.0f, 0.0f, -5.0f, NAN, INFINITY, 1e-9f, 86400.0f,
                   1e30f, 0.03f}) {
    stage.tick(dt);
    EXPECT_TRUE(stage.finite()) << dt;
  }
  stage.input.guests.clear();
  for (float dt : {3600.0f, 3600.0f, 0.0f, 3600.0f}) {
    stage.tick(dt);
    EXPECT_TRUE(stage.finite()) << dt;
  }
}

TEST(Storyteller, NoTimeIsNoMovement) {
  Stage stage;
  stage.run(5);
  Pose before = stage.pose;
  stage.tick(0);
  for (size_t j = 0; j < before.rotations.size(); j++)
    EXPECT_LT(glm::length(before.rotations[j] - stage.pose.rotations[j]), 1e-5f);
}

TEST(Storyteller, MotionIsContinuous) {
  Stage stage;
  stage.run(1);
  for (int i = 0; i < 6000; i++) {
    if (i == 1000) stage.input.guests = {{1, {1, 1.6f, 1}, vec3(0), true}};
    if (i == 2500) stage.input.guests.clear();
    vec3 hand = stage.frame("r_radiocarpal").center, head = stage.frame("skullbase").center;
    stage.tick(0.01f);
    EXPECT_LT(glm::length(stage.frame("r_radiocarpal").center - hand), 0.03f) << i;
    EXPECT_LT(glm::length(stage.frame("skullbase").center - head), 0.01f) << i;
  }
}

TEST(Storyteller, ADayOfIdlingDoesNotDrift) {
  Stage stage;
  double seconds = 0;
  while (seconds < 86400) {
    stage.tick(0.9f);
    seconds += 0.9;
    ASSERT_TRUE(stage.finite());
    ASSERT_LT(glm::length(stage.pose.translation), 0.06f);
  }
  EXPECT_LT(glm::length(stage.frame("skullbase").center - vec3(0, 1.52f, 0)), 0.08f);
  EXPECT_NEAR(stage.state.clock, 86400, 5);
  EXPECT_GT(stage.state.blink.count, 15000);
}

bool same(const Pose& a, const Pose& b) {
  return a.rotations.size() == b.rotations.size() &&
         std::memcmp(a.rotations.data(), b.rotations.data(), a.rotations.size() * sizeof(quat)) ==
             0 &&
         a.displacers == b.displacers && a.translation == b.translation;
}

void play(Stage& stage, int i) {
  if (i == 100) stage.input.guests = {{1, {0.4f, 1.6f, 1}, vec3(0.3f, 0, 0), true}};
  if (i == 250) stage.input.speaking = 0.8f;
  if (i == 400) stage.input.guests.clear(), stage.input.speaking = 0;
  stage.tick(1 / 30.0f);
}

TEST(Storyteller, ReplaysAreBitIdenticalAndCopiesGoOnAlike) {
  for (bool humanlike : {false, true}) {
    Stage a, b;
    a.input.humanlike = b.input.humanlike = humanlike;
    for (int i = 0; i < 600; i++) {
      play(a, i);
      play(b, i);
      ASSERT_TRUE(same(a.pose, b.pose)) << i;
      if (i == 300) {
        StorytellerState copy = b.state;
        b.state = {};
        b.state = copy;
      }
    }
  }
}

TEST(Storyteller, CalmMeansNoNoise) {
  Stage stage;
  stage.input.humanlike = false;
  Rng before = stage.state.rng;
  stage.run(60);
  EXPECT_EQ(stage.state.rng.state, before.state);
  vec3 head = stage.frame("skullbase").rotation * vec3(0, 0, 1);
  float largest = 0;
  for (int i = 0; i < 600; i++) {
    stage.tick(1 / 30.0f);
    largest =
        std::max(largest, angle_between(head, stage.frame("skullbase").rotation * vec3(0, 0, 1)));
  }
  EXPECT_LT(largest, 1 * deg) << "only the breath";
  Stage lively;
  lively.run(60);
  head = lively.frame("skullbase").rotation * vec3(0, 0, 1);
  largest = 0;
  for (int i = 0; i < 600; i++) {
    lively.tick(1 / 30.0f);
    largest =
        std::max(largest, angle_between(head, lively.frame("skullbase").rotation * vec3(0, 0, 1)));
  }
  EXPECT_GT(largest, 3 * deg);
}

TEST(Storyteller, AnyFigureAndNoFigure) {
  StorytellerEvents events;
  Pose pose;
  StorytellerState state;
  StorytellerInput input;
  tick_storyteller(state, Storyteller{}, input, pose, events);
  for (const std::string& skeleton :
       {std::string("<HAnimJoint name='humanoid_root' containerField='skeleton'/>"),
        std::string("<HAnimJoint name='strange' containerField='skeleton'><HAnimJoint "
                    "name='other'/></HAnimJoint>"),
        std::string("<HAnimJoint name='l_shoulder' containerField='skeleton'><HAnimJoint "
                    "name='l_elbow'/></HAnimJoint>"),
        std::string(
            "<HAnimJoint name='humanoid_root' containerField='skeleton'><HAnimJoint "
            "name='l_hip'><HAnimJoint "
            "name='l_knee'><HAnimJoint name='l_ankle'/></HAnimJoint></HAnimJoint><HAnimJoint "
            "name='skullbase'/></HAnimJoint>")}) {
    Character character =
        test::load_text(test::x3d("<HAnimHumanoid>" + skeleton + "</HAnimHumanoid>"));
    Storyteller storyteller{&character, mat4(1)};
    input.guests = {{1, {0, 0, 0}, vec3(0), true}, {2, {1e9f, 0, 0}, vec3(0), true}};
    for (int i = 0; i < 300; i++) {
      input.dt = 0.05f;
      if (i == 200) input.guests.clear();
      tick_storyteller(state, storyteller, input, pose, events);
      ASSERT_EQ(pose.rotations.size(), character.joints.size());
      for (quat q : pose.rotations) EXPECT_NEAR(glm::length(q), 1, 1e-3f);
    }
    eval_gaze(state, storyteller, pose);
  }
}

}  // namespace
}  // namespace wellspring::test
