// SPDX-License-Identifier: Apache-2.0
// Limits of a file's joints: what a turn becomes, and that looking, pointing and gesturing keep to
// them.
#include <gtest/gtest.h>

#include "avatar/body/body.h"
#include "avatar/figure/joint_limits.h"
#include "avatar/mind/storyteller.h"
#include "base/rng.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

vec3 rotation_vector(quat q) {
  if (q.w < 0) q = -q;
  vec3 axis(q.x, q.y, q.z);
  float sine = glm::length(axis);
  return sine < 1e-9f ? 2.0f * axis : axis * (2 * std::atan2(sine, q.w) / sine);
}

quat random_rotation(Rng& rng) {
  quat q;
  do
    q = quat(rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f,
             rng.uniform() - 0.5f);
  while (glm::length(q) < 0.05f || glm::length(q) > 0.5f);
  return glm::normalize(q);
}

// Returns how far a joint's turn is beyond its limits, radians.
float beyond(const Joint& joint, quat turn) {
  vec3 v =
      rotation_vector(glm::conjugate(joint.limit_orientation) * turn * joint.limit_orientation);
  float most = 0;
  for (int i = 0; i < 3 && has_limits(joint); i++)
    most = std::max({most, joint.limits[size_t(i)].x - v[i], v[i] - joint.limits[size_t(i)].y});
  return most;
}

TEST(JointLimits, AreKeptWhateverTheTurn) {
  Rng rng{7};
  for (int i = 0; i < 20000; i++) {
    Joint joint;
    for (int axis = 0; axis < 3; axis++)
      joint.limits.push_back({-1.5f * rng.uniform(), 1.5f * rng.uniform()});
    joint.limit_orientation = random_rotation(rng);
    quat turn = random_rotation(rng), kept = limit_turn(joint, turn),
         same = limit_turn(joint, -turn);
    EXPECT_NEAR(std::abs(glm::dot(kept, same)), 1, 1e-5) << "the same turn, the other quaternion";
    EXPECT_NEAR(glm::length(kept), 1, 1e-4);
    EXPECT_LT(beyond(joint, kept), 1e-3f);
    EXPECT_NEAR(std::abs(glm::dot(limit_turn(joint, kept), kept)), 1, 1e-5) << "once is enough";
    if (beyond(joint, turn) <= 0) EXPECT_EQ(kept, turn);
  }
}

TEST(JointLimits, NoneAreNone) {
  quat turn = glm::angleAxis(2.0f, normalize(vec3(1, 2, 3)));
  Joint joint;
  EXPECT_EQ(limit_turn(joint, turn), turn);
  joint.limits = {{0, 0}, {0, 0}, {0, 0}};
  EXPECT_FALSE(has_limits(joint)) << "written by those who know none";
  EXPECT_EQ(limit_turn(joint, turn), turn);
  joint.limits = {{1, -1}, {-0.2f, 0.2f}, {NAN, NAN}};
  vec3 v = rotation_vector(limit_turn(joint, turn)), free = rotation_vector(turn);
  EXPECT_NEAR(v.x, free.x, 1e-5);
  EXPECT_NEAR(v.y, 0.2f, 1e-5);
  EXPECT_NEAR(v.z, free.z, 1e-5);
  joint.limits = {{0.5f, 1}, {-1, 1}, {-1, 1}};
  EXPECT_EQ(limit_turn(joint, quat(1, 0, 0, 0)), quat(1, 0, 0, 0))
      << "the rest pose is always allowed";
}

// A figure whose neck, arms and eyes are limited, looking and pointing everywhere.
TEST(JointLimits, LookingPointingAndGesturesKeepToThem) {
  Character figure = test::load_text(test::whole_figure());
  for (Joint& joint : figure.joints) {
    bool leg = joint.name.find("hip") != std::string::npos ||
               joint.name.find("knee") != std::string::npos ||
               joint.name.find("talocrural") != std::string::npos || joint.name == "humanoid_root";
    if (leg) continue;
    float most = joint.name.find("shoulder") != std::string::npos ||
                         joint.name.find("elbow") != std::string::npos
                     ? 1.9f
                     : 0.25f;
    joint.limits.assign(3, {-most, most});
    joint.limit_orientation = glm::angleAxis(0.7f, normalize(vec3(1, 1, 0)));
  }
  Storyteller storyteller{.character = &figure};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  input.dt = 1 / 30.0f;
  float worst = 0;
  int frame = 0;
  for (const char* gesture : {"point_far", "wave", "count_three", "open_arms", "bow", "think"})
    for (int i = 0; i < 90; i++, frame++) {
      float angle = 0.05f * float(frame);
      input.story.look =
          vec3(2 * std::sin(angle), 1.5f + std::cos(1.7f * angle), 2 * std::cos(angle));
      input.story.point = vec3(std::sin(angle), 1 + 0.5f * std::sin(2 * angle), 1.2f);
      input.story.gesture = i == 0 ? gesture : "";
      input.telling = true;
      tick_storyteller(state, storyteller, input, pose, events);
      for (size_t j = 0; j < figure.joints.size(); j++)
        worst = std::max(worst, beyond(figure.joints[j], pose.rotations[j]));
    }
  EXPECT_LT(worst, 2e-3f);
}

// A shoulder that may hardly turn outwards: elbow and wrist make up for it.
TEST(JointLimits, APointingArmMakesUpForAShoulderThatMayNot) {
  Character figure = test::load_text(test::whole_figure());
  Rig free_rig = make_rig(figure);
  ASSERT_GE(free_rig.arm[1].shoulder, 0);
  vec3 target = figure.joints[size_t(free_rig.arm[1].shoulder)].center + vec3(-0.8f, -0.3f, 1.5f);
  auto point = [&](const Character& character) {
    Rig rig = make_rig(character);
    Pose pose = make_rest_pose(character);
    float left = point_arm(rig, 1, Aim::finger, target, 1, pose);
    PointingLine line = eval_pointing_line(rig, pose, 1, Aim::finger);
    vec3 way = target - line.from;
    EXPECT_NEAR(left, std::atan2(glm::length(cross(line.direction, way)), dot(line.direction, way)),
                1e-3);
    return std::pair(left, pose.rotations[size_t(rig.arm[1].shoulder)]);
  };
  auto [free_error, free_turn] = point(figure);
  EXPECT_LT(free_error, 0.035f);
  Character limited = figure;
  Joint& shoulder = limited.joints[size_t(free_rig.arm[1].shoulder)];
  float angle = glm::length(rotation_vector(free_turn));
  shoulder.limits.assign(3, {-0.45f * angle, 0.45f * angle});
  ASSERT_GT(beyond(shoulder, free_turn), 0.05f) << "the limit matters";
  auto [error, turn] = point(limited);
  EXPECT_LE(beyond(shoulder, turn), 1e-3f);
  EXPECT_LT(error, 0.035f) << "2 degrees";
}

TEST(JointLimits, StiffJointsTurnLess) {
  Character figure = test::load_text(test::whole_figure());
  Rig even = make_rig(figure);
  ASSERT_GE(even.spine.size(), 2u);
  figure.joints[size_t(even.spine[0].joint)].stiffness = vec3(0.9f);
  Rig stiff = make_rig(figure);
  EXPECT_LT(stiff.spine[0].share, 0.3f * even.spine[0].share);
  float sum = 0;
  for (const WeightedJoint& link : stiff.spine) sum += link.share;
  EXPECT_NEAR(sum, 1, 1e-5);
}

}  // namespace
}  // namespace wellspring::test
