// SPDX-License-Identifier: Apache-2.0
// Pointing and looking at places, and feet that stay where they stand meanwhile.
#include <gtest/gtest.h>

#include <filesystem>

#include "avatar/body/body.h"
#include "avatar/mind/storyteller.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

float angle_between(vec3 a, vec3 b) { return std::atan2(glm::length(cross(a, b)), dot(a, b)); }

struct Stage {
  explicit Stage(const Character& figure) : character(figure) {
    storyteller.character = &character;
  }
  const Character& character;
  Storyteller storyteller;
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  void run(double seconds, float dt = 1 / 30.0f) {
    for (double t = 0; t < seconds - 1e-6; t += double(dt)) {
      input.dt = dt;
      tick_storyteller(state, storyteller, input, pose, events);
    }
  }
  float pointing_error(int side, vec3 place) const {
    PointingLine line = eval_pointing_line(*state.rig, pose, side, Aim::finger);
    return angle_between(line.direction, place - line.from);
  }
  float yaw(const char* joint) const {
    vec3 ahead =
        eval_joint_frame(character, pose, find_joint(character, joint)).rotation * vec3(0, 0, 1);
    return std::atan2(ahead.x, ahead.z);
  }
};

const Character& boxes() {
  static const Character figure = test::load_text(test::whole_figure());
  return figure;
}
const Character& ludmila() {
  static const Character figure =
      load_character(std::string(WELLSPRING_SOURCE) + "/content/castle/figures/storyteller.x3d");
  return figure;
}

// Every place of a grid around the figure; it may turn its body, as people do.
TEST(Pointing, IsWithinTwoDegreesOfEveryPlaceThatCanBeReached) {
  for (const Character* figure : {&boxes(), &ludmila()}) {
    float worst = 0;
    int places = 0;
    for (float distance : {0.8f, 1.5f, 4.0f, 12.0f})
      for (float yaw = -180; yaw < 180; yaw += 22.5f)
        for (float height : {0.3f, 1.0f, 1.6f, 2.6f}) {
          vec3 place(distance * std::sin(yaw * pi / 180), height,
                     distance * std::cos(yaw * pi / 180));
          Stage stage(*figure);
          stage.input.humanlike = false;
          stage.run(0.1);
          stage.input.story.point = place;
          stage.run(6);
          int side = stage.state.gesture.mirrored ? 0 : 1;
          ASSERT_GE(stage.state.gesture.clip, 0);
          float error = stage.pointing_error(side, place);
          worst = std::max(worst, error);
          places++;
          EXPECT_LE(error, 2 * pi / 180)
              << distance << " m, " << yaw << " deg, at " << height << " m high";
        }
    EXPECT_EQ(places, 256);
    RecordProperty(figure == &boxes() ? "worst_boxes" : "worst_ludmila",
                   std::to_string(worst * 180 / pi));
  }
}

TEST(Pointing, KeepsToTheLimitsOfTheJoint) {
  // The body cannot turn here: only the arm is asked, for places all around.
  Stage stage(boxes());
  stage.run(0.1);
  const Rig& rig = *stage.state.rig;
  Rng rng(4);
  int beyond = 0;
  for (int i = 0; i < 2000; i++) {
    vec3 way(rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f);
    vec3 place = vec3(0, 1.3f, 0) + 3.0f * glm::normalize(way);
    BodyPlan plan;
    for (ArmPose& arm : plan.arm) arm = hanging_arm(0.1f);
    plan.arm[1].elbow = 0.2f;
    Pose pose = make_rest_pose(boxes());
    eval_body(rig, plan, pose);
    float left = point_arm(rig, 1, Aim::finger, place, 1, pose);
    vec3 shoulder = eval_joint_frame(boxes(), pose, rig.arm[1].shoulder).center;
    vec3 elbow = eval_joint_frame(boxes(), pose, rig.arm[1].elbow).center;
    vec3 arm = glm::normalize(elbow - shoulder);
    float up = std::asin(arm.y), out = std::atan2(-arm.x, arm.z);
    EXPECT_LE(up, arm_up + 1e-3f);
    if (up > -0.79f) {  // lower down it hangs, and may hang anywhere
      // The angle is an arc: near the pole an angle about the vertical is worth little.
      EXPECT_LE((out - arm_outward) * std::cos(up), 1e-3f);
      EXPECT_LE((-arm_across - out) * std::cos(up), 1e-3f);
    }
    // The angle left is the one that is seen.
    PointingLine line = eval_pointing_line(rig, pose, 1, Aim::finger);
    EXPECT_NEAR(left, angle_between(line.direction, place - line.from), 2e-3f);
    beyond += left > 2 * pi / 180;
  }
  EXPECT_GT(beyond, 50) << "some places are behind it";
  EXPECT_LT(beyond, 1200);
  Pose pose = make_rest_pose(boxes());
  EXPECT_EQ(point_arm(rig, 1, Aim::finger, {NAN, 0, 0}, 1, pose), pi);
  EXPECT_EQ(
      point_arm(rig, 1, Aim::finger, boxes().joints[size_t(rig.arm[1].shoulder)].center, 1, pose),
      pi);
}

TEST(Pointing, GoesOverFromPlaceToPlaceWithoutAJump) {
  Stage stage(boxes());
  stage.input.humanlike = false;
  const vec3 places[] = {{2, 1, 2}, {-2, 1.5f, 2}, {0.3f, 1, 0.8f}, {1, 2.5f, 3}};
  int wrist[2] = {find_joint(boxes(), "l_radiocarpal"), find_joint(boxes(), "r_radiocarpal")};
  stage.run(1);
  vec3 last[2];
  for (int i = 0; i < 2400; i++) {
    for (int s = 0; s < 2; s++) last[s] = eval_joint_frame(boxes(), stage.pose, wrist[s]).center;
    if (i % 300 == 200) stage.input.story.point.reset();
    if (i % 300 == 250 || i % 300 == 100) stage.input.story.point = places[(i / 100) % 4];
    stage.run(0.01, 0.01f);
    for (int s = 0; s < 2; s++)
      ASSERT_LT(glm::length(eval_joint_frame(boxes(), stage.pose, wrist[s]).center - last[s]),
                0.045f)
          << i;
  }
}

TEST(Looking, EyesThenHeadThenChestByTheirTimes) {
  for (float side : {-1.0f, 1.0f}) {
    Stage stage(boxes());
    stage.input.humanlike = false;
    stage.run(3);
    float goal = side * 0.7f;
    stage.input.story.look = vec3(3 * std::sin(goal), 1.6f, 3 * std::cos(goal));
    // Nine tenths of what each of them does in the end, in this order.
    Stage end = stage;
    end.run(8);
    double eyes = -1, head = -1, chest = -1, time = 0;
    while (time < 5 && chest < 0) {
      stage.run(0.005, 0.005f);
      time += 0.005;
      float seen = stage.yaw("l_eyeball_joint") / end.yaw("l_eyeball_joint");
      if (eyes < 0 && seen > 0.9f) eyes = time;
      if (head < 0 && stage.yaw("skullbase") / end.yaw("skullbase") > 0.9f) head = time;
      if (chest < 0 && stage.yaw("vt6") / end.yaw("vt6") > 0.9f) chest = time;
    }
    EXPECT_LT(eyes, head);
    EXPECT_LT(head, chest);
    EXPECT_NEAR(head, double(head_seconds), 0.08);
    EXPECT_NEAR(chest, double(torso_seconds), 0.1);
    vec3 ahead =
        eval_joint_frame(boxes(), end.pose, find_joint(boxes(), "l_eyeball_joint")).rotation *
        vec3(0, 0, 1);
    vec3 eye = eval_joint_frame(boxes(), end.pose, find_joint(boxes(), "l_eyeball_joint")).center;
    EXPECT_LT(angle_between(ahead, *stage.input.story.look - eye), 2 * pi / 180);
  }
}

TEST(Feet, DoNotSlideDuringAnyGesture) {
  for (const Character* figure : {&boxes(), &ludmila()}) {
    Stage stage(*figure);
    int ankle[2] = {find_joint(*figure, "l_talocrural"), find_joint(*figure, "r_talocrural")};
    stage.run(1);
    vec3 planted[2];
    for (int s = 0; s < 2; s++) planted[s] = eval_joint_frame(*figure, stage.pose, ankle[s]).center;
    float drift = 0;
    for (const GestureClip& clip : default_gestures().clips) {
      stage.input.story.gesture = clip.name;
      stage.run(1 / 30.0);
      stage.input.story.gesture.clear();
      for (double t = 0; t < double(clip.seconds); t += 1 / 30.0) {
        stage.run(1 / 30.0);
        for (int s = 0; s < 2; s++)
          drift = std::max(
              drift,
              glm::length(eval_joint_frame(*figure, stage.pose, ankle[s]).center - planted[s]));
      }
    }
    EXPECT_LT(drift, 0.003f) << "metres, over all gestures with all noise";
    RecordProperty("drift", std::to_string(drift));
  }
}

}  // namespace
}  // namespace wellspring::test
