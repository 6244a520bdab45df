// SPDX-License-Identifier: Apache-2.0
// The laws of docs/expressions.md, over random sums on a figure that has every control.
#include <gtest/gtest.h>

#include <cstring>

#include "avatar/face/expression_sum.h"
#include "avatar/face/face.h"
#include "avatar/speech/visemes.h"
#include "base/rng.h"

namespace wellspring::test {
namespace {

// All controls of the set as displacers of their own, and the joints that its rotators turn.
Character figure_with_everything() {
  Character character;
  for (const Control& control : default_expressions().controls)
    if (!control.displacers.empty())
      character.displacers.push_back({control.displacers[0], {}, {}});
  int parent = -1;
  for (const char* name : {"humanoid_root", "vc4", "skullbase"}) {
    Joint joint{.name = name, .parent = parent};
    parent = int(character.joints.size());
    character.joints.push_back(joint);
  }
  character.positions = {vec3(0)};
  character.first_weight = {0, 1};
  character.weights = {{2, 1}};
  return character;
}

struct Algebra : testing::Test {
  Character character = figure_with_everything();
  ExpressionRig rig = make_expression_rig(default_expressions(), character);
  Rng rng{42};

  float any(float low, float high) { return low + (high - low) * rng.uniform(); }
  ExpressionSum random_sum(float largest = 2) {
    ExpressionSum sum;
    clear(sum, rig);
    for (int i = 0; i < 6; i++)
      add(sum, rig, int(rng.next() % rig.set->expressions.size()), any(-largest, largest));
    return sum;
  }
  Pose posed(const ExpressionSum& sum) const {
    Pose pose = make_rest_pose(character);
    apply_rotators(sum, rig, pose);
    apply_controls(sum, rig, pose);
    return pose;
  }
  float distance(const ExpressionSum& a, const ExpressionSum& b) const {
    float most = 0;
    for (size_t i = 0; i < a.controls.size(); i++)
      most = std::max(most, std::abs(a.controls[i] - b.controls[i]));
    for (size_t i = 0; i < a.rotators.size(); i++)
      most = std::max(most, std::abs(a.rotators[i] - b.rotators[i]));
    return most;
  }
  float shown(const Pose& pose, const char* displacer) const {
    return pose.displacers[size_t(find_displacer(character, displacer))];
  }
};

bool same_bits(const Pose& a, const Pose& b) {
  return a.displacers == b.displacers && a.rotations.size() == b.rotations.size() &&
         std::memcmp(a.rotations.data(), b.rotations.data(), a.rotations.size() * sizeof(quat)) ==
             0;
}

TEST_F(Algebra, TheFigureLacksNothing) { EXPECT_TRUE(rig.missing.empty()) << rig.missing[0]; }

TEST_F(Algebra, TheEmptySumIsTheIdentity) {
  ExpressionSum empty;
  clear(empty, rig);
  for (int i = 0; i < 500; i++) {
    ExpressionSum a = random_sum(), b = a;
    add(b, empty, any(-5, 5));
    EXPECT_EQ(a.controls, b.controls);
    EXPECT_EQ(a.rotators, b.rotators);
    add(b, random_sum(), 0);  // a weight of nothing
    EXPECT_EQ(a.controls, b.controls);
  }
  Pose rest = make_rest_pose(character);
  EXPECT_TRUE(same_bits(posed(empty), rest));
}

TEST_F(Algebra, AdditionIsCommutativeAndAssociative) {
  for (int i = 0; i < 500; i++) {
    ExpressionSum a = random_sum(), b = random_sum(), c = random_sum();
    ExpressionSum ab = a, ba = b;
    add(ab, b, 1);
    add(ba, a, 1);
    EXPECT_EQ(ab.controls, ba.controls) << "bit for bit";
    EXPECT_EQ(ab.rotators, ba.rotators);
    EXPECT_TRUE(same_bits(posed(ab), posed(ba)));
    ExpressionSum left = ab, right = b;
    add(left, c, 1);
    add(right, c, 1);
    add(right, a, 1);
    EXPECT_LT(distance(left, right), 1e-5f);
  }
}

TEST_F(Algebra, ScalingIsLinearAndOppositeWeightsLeaveNothing) {
  for (int i = 0; i < 500; i++) {
    ExpressionSum a = random_sum(), twice, back = a;
    clear(twice, rig);
    float w = any(-2, 2);
    add(twice, a, w);
    add(twice, a, -w);
    ExpressionSum empty;
    clear(empty, rig);
    // Nothing but the rounding of one product, which a fused multiply-add does not lose: 24 *
    // 2^-24.
    EXPECT_LE(distance(twice, empty), 24 * 0x1p-24f);
    add(back, random_sum(), 0);
    EXPECT_EQ(distance(back, a), 0);
  }
}

TEST_F(Algebra, MeansOfWeightsThatSumToNothingAreEmpty) {
  ExpressionSum empty;
  clear(empty, rig);
  for (int i = 0; i < 500; i++) {
    ExpressionSum a = random_sum(), b = random_sum(), c = random_sum();
    float w = any(0.01f, 3);
    EXPECT_EQ(distance(mean(rig, {a, b}, {w, -w}), empty), 0);
    EXPECT_EQ(distance(mean(rig, {a, b, c}, {w, -0.5f * w, -0.5f * w}), empty), 0);
    EXPECT_EQ(distance(mean(rig, {a, b}, {0, 0}), empty), 0);
    EXPECT_EQ(distance(mean(rig, {}, {}), empty), 0);
    EXPECT_LT(distance(mean(rig, {a, a, a}, {w, 2 * w, 0.3f}), a), 1e-5f);
    EXPECT_LT(distance(mean(rig, {a, b}, {1, 0}), a), 1e-6f);
  }
}

TEST_F(Algebra, WhatIsAppliedIsClampedOnceAndInAnyOrder) {
  for (int i = 0; i < 300; i++) {
    Pose pose = posed(random_sum(10));
    for (float w : pose.displacers) EXPECT_TRUE(w >= 0 && w <= 1);
    for (quat q : pose.rotations) EXPECT_NEAR(glm::length(q), 1, 1e-5f);
  }
  // 3 - 2.5 = 0.5 whatever comes first: a clamp in between would give 0 or 1.
  int smile = find_expression(*rig.set, "smile_l");
  for (bool first : {false, true}) {
    ExpressionSum sum;
    clear(sum, rig);
    add(sum, rig, smile, first ? 3.0f : -2.5f);
    add(sum, rig, smile, first ? -2.5f : 3.0f);
    EXPECT_NEAR(shown(posed(sum), "smile_l"), 0.5f, 1e-6f);
  }
}

TEST_F(Algebra, NothingThatIsNoNumberGetsIn) {
  for (float bad : {NAN, INFINITY, -INFINITY}) {
    ExpressionSum a = random_sum(), b = a;
    add(b, rig, find_expression(*rig.set, "joy"), bad);
    add(b, random_sum(), bad);
    add(b, rig, -1, 1);
    add(b, rig, 1 << 30, 1);
    EXPECT_EQ(a.controls, b.controls);
    EXPECT_LT(distance(mean(rig, {a, a}, {1, bad}), a), 1e-6f);
    Protected words;
    words.visemes.fill(bad);
    words.closing = {bad, bad};
    words.talking = bad;
    protect(b, rig, words);
    for (float w : posed(b).displacers) EXPECT_TRUE(w >= 0 && w <= 1);
  }
}

TEST_F(Algebra, LipsMeetAtABilabialWhateverTheLayersSay) {
  for (int i = 0; i < 500; i++) {
    ExpressionSum sum = random_sum(3);
    Protected words{.talking = rng.uniform()};
    for (float& viseme : words.visemes) viseme = rng.uniform();
    words.visemes[size_t(Viseme::PP)] = 1;
    protect(sum, rig, words);
    Pose pose = posed(sum);
    EXPECT_EQ(shown(pose, "viseme_PP"), 1);
    for (size_t c = 0; c < rig.set->controls.size(); c++) {
      const Control& control = rig.set->controls[c];
      bool other_shape = control.kind == ControlKind::viseme && control.name != "viseme_PP" &&
                         control.name != "viseme_FF";
      if (control.kind == ControlKind::parts_lips || other_shape)
        EXPECT_EQ(sum.controls[c], 0) << control.name;
    }
  }
}

TEST_F(Algebra, ABlinkClosesTheLidsWhateverTheLayersSay) {
  for (int i = 0; i < 500; i++) {
    ExpressionSum sum = random_sum(3);
    Protected words{.closing = {1, rng.uniform()}};
    protect(sum, rig, words);
    Pose pose = posed(sum);
    EXPECT_EQ(shown(pose, "blink_l"), 1);
    EXPECT_EQ(shown(pose, "lid_wide_l"), 0);
    EXPECT_EQ(shown(pose, "squint_l"), 0);
    EXPECT_GE(shown(pose, "blink_r"), words.closing[1] - 1e-6f) << "never more open than the blink";
  }
}

TEST_F(Algebra, EachEmotionReachesItsFaceAndTheyDiffer) {
  std::vector<std::vector<float>> faces;
  for (size_t i = 0; i < emotion_count; i++) {
    ASSERT_GE(rig.emotion[i], 0);
    ExpressionSum half, whole;
    clear(half, rig);
    clear(whole, rig);
    add(half, rig, rig.emotion[i], 0.5f);
    add(whole, rig, rig.emotion[i], 1);
    float most = 0;
    for (size_t c = 0; c < whole.controls.size(); c++) {
      EXPECT_NEAR(whole.controls[c], 2 * half.controls[c], 1e-6f);
      most = std::max(most, whole.controls[c]);
    }
    EXPECT_GT(most, 0.7f) << emotion_names[i];
    faces.push_back(whole.controls);
  }
  for (size_t a = 0; a < faces.size(); a++)
    for (size_t b = 0; b < a; b++) {
      float difference = 0;
      for (size_t c = 0; c < faces[a].size(); c++)
        difference = std::max(difference, std::abs(faces[a][c] - faces[b][c]));
      EXPECT_GT(difference, 0.3f) << emotion_names[a] << " and " << emotion_names[b];
    }
}

TEST_F(Algebra, AntipodalQuaternionsAreTheSameTurn) {
  // Orientations written the long way round (angles of more than half a turn) interpolate as the
  // short one.
  for (int i = 0; i < 500; i++) {
    vec3 axis = glm::normalize(vec3(any(-1, 1), any(-1, 1), any(-1, 1)) + vec3(1e-3f));
    float angle = any(-0.9f, 0.9f) * pi, weight = any(-1.5f, 1.5f);
    quat turn = glm::angleAxis(angle, axis);
    Rotator a{"a", "skullbase", {-1, 0, 1}, {}, {glm::conjugate(turn), quat(1, 0, 0, 0), turn}};
    Rotator b = a;
    for (quat& q : b.orientations)
      if (rng.uniform() < 0.5f) q = -q;
    quat x = eval_rotator(a, weight), y = eval_rotator(b, weight);
    EXPECT_NEAR(std::abs(glm::dot(x, y)), 1, 1e-5f);
    EXPECT_NEAR(2 * std::acos(std::min(std::abs(x.w), 1.0f)),
                std::abs(angle) * std::min(std::abs(weight), 1.0f), 2e-3f);
  }
  Rotator half_turn{
      "h", "skullbase", {0, 1}, {}, {quat(1, 0, 0, 0), glm::angleAxis(pi, vec3(1, 0, 0))}};
  for (float w : {0.0f, 0.5f, 1.0f, NAN, INFINITY})
    EXPECT_NEAR(glm::length(eval_rotator(half_turn, w)), 1, 1e-5f);
}

TEST(EmotionAlgebra, LayersKeepTheirLaws) {
  Rng rng(9);
  auto random = [&](float low, float high) {
    Emotions e;
    for (float& w : e.weight) w = low + (high - low) * rng.uniform();
    return e;
  };
  for (int i = 0; i < 2000; i++) {
    Emotions story = random(-0.5f, 2), visitor = random(-0.5f, 2);
    EXPECT_EQ(add(story, Emotions{}, 3), story);
    EXPECT_EQ(add(story, visitor, 0), story);
    EXPECT_EQ(add(story, visitor, 1), add(visitor, story, 1));
    EXPECT_EQ(mix(story, visitor, 1), visitor);
    Emotions shown = bounded(add(story, visitor, rng.uniform()));
    float sum = 0;
    for (float w : shown.weight) {
      EXPECT_TRUE(w >= 0 && w <= 1);
      sum += w;
    }
    EXPECT_LE(sum, 1 + 1e-5f);
    EXPECT_EQ(std::min(shown[Emotion::joy], shown[Emotion::sadness]), 0) << "no grimace of both";
    EXPECT_EQ(std::min(shown[Emotion::anger], shown[Emotion::fear]), 0);
    // Idempotent up to rounding of the division.
    Emotions again = bounded(shown);
    for (size_t k = 0; k < emotion_count; k++) EXPECT_NEAR(again.weight[k], shown.weight[k], 1e-6f);
    // A farewell leaves nothing of the story.
    EXPECT_EQ(layered(story, visitor, 0.6f, 1), layered(Emotions{}, visitor, 0.6f, 1));
    EXPECT_EQ(layered(story, visitor, 0, 0), bounded(story));
  }
  Emotions bad;
  bad.weight.fill(NAN);
  EXPECT_EQ(bounded(bad), Emotions{});
  EXPECT_EQ(add(Emotions{}, bad, 1), Emotions{});
  EXPECT_EQ(bounded(layered(Emotions{}, bad, NAN, NAN)), Emotions{});
}

}  // namespace
}  // namespace wellspring::test
