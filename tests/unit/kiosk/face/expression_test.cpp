// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wellspring::test {
namespace {

FacePlane rest_face() {
  FacePlane face;
  for (size_t k = 0; k < face.size(); k++) face[k] = vec2(face_point(k));
  return face;
}

FacePlane smiling() {
  FacePlane face = rest_face();
  for (size_t k : {48u, 60u}) face[k] += vec2(-0.005f, -0.006f);
  for (size_t k : {54u, 64u}) face[k] += vec2(0.005f, -0.006f);
  return face;
}

FacePlane surprised() {
  FacePlane face = rest_face();
  for (size_t k = 17; k < 27; k++) face[k].y -= 0.010f;
  for (size_t k : {6u, 7u, 8u, 9u, 10u, 57u, 58u, 56u, 66u}) face[k].y += 0.014f;
  return face;
}

FaceClasses sure_of(FaceClass which, float sure = 0.9f) {
  FaceClasses classes;
  classes.fill((1 - sure) / 6);
  classes[size_t(which)] = sure;
  return classes;
}

TEST(Fap, a_face_at_rest_does_not_move) {
  auto faps = measure_faps(rest_face(), rest_face());
  ASSERT_TRUE(faps);
  for (float fap : *faps) EXPECT_NEAR(fap, 0, 0.01f);
}

TEST(Fap, moving_turning_and_coming_nearer_is_no_expression) {
  FacePlane face = rest_face();
  for (vec2& p : face)
    p = 1.1f * vec2(0.98f * p.x + 0.2f * p.y, -0.2f * p.x + 0.98f * p.y) + vec2(0.02f, -0.01f);
  auto faps = measure_faps(rest_face(), face);
  ASSERT_TRUE(faps);
  for (float fap : *faps) EXPECT_NEAR(fap, 0, 1);
}

TEST(Fap, a_smile_raises_and_stretches_the_corners_of_the_lips_alone) {
  auto faps = measure_faps(rest_face(), smiling());
  ASSERT_TRUE(faps);
  for (int fap : {6, 7, 53, 54}) EXPECT_GT((*faps)[size_t(fap)], 50) << fap;
  for (int fap : {12, 13, 59, 60}) EXPECT_GT((*faps)[size_t(fap)], 150) << fap;
  for (int fap : {3, 19, 20, 31, 32, 33, 34, 35, 36, 37, 38})
    EXPECT_NEAR((*faps)[size_t(fap)], 0, 1) << fap;
}

TEST(Fap, what_is_no_face_is_refused) {
  FacePlane flat{};
  EXPECT_FALSE(measure_faps(flat, rest_face()));
  FacePlane torn = rest_face();
  torn[54].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(measure_faps(rest_face(), torn));
}

TEST(Fap, the_plane_of_a_turned_head_is_that_of_a_straight_one) {
  const Mount mount;
  const float focal = focal_length(mount, 640, 480);
  FaceMarks marks;
  const HeadPose pose{mat3(glm::rotate(mat4(1), 0.4f, glm::normalize(vec3(0.3f, 1, 0.2f)))),
                      {0.1f, -0.05f, 0.9f},
                      0};
  for (size_t k = 0; k < marks.size(); k++) {
    const vec3 p = pose.position + pose.rotation * face_point(k);
    marks[k] = vec2(p.x, p.y) / p.z * focal + vec2(320, 240);
  }
  const FacePlane plane = face_plane(marks, pose, focal, 640, 480), rest = rest_face();
  for (size_t k = 0; k < plane.size(); k++) EXPECT_LT(glm::length(plane[k] - rest[k]), 1e-5f) << k;
}

TEST(Expression, movements_alone_tell_joy_from_surprise) {
  const Expression joy = expression_of(*measure_faps(rest_face(), smiling()));
  EXPECT_GT(joy.joy, 0.5f);
  EXPECT_LT(joy.surprise + joy.anger + joy.sadness + joy.fear + joy.disgust, 0.1f);
  const Expression surprise = expression_of(*measure_faps(rest_face(), surprised()));
  EXPECT_GT(surprise.surprise, 0.5f);
  EXPECT_LT(surprise.joy + surprise.anger + surprise.sadness + surprise.disgust, 0.1f);
  EXPECT_EQ(expression_of({}), Expression{});
}

// A face whose rest the network takes for sad is not sad; when it smiles, joy rises.
TEST(Expression, rest_is_learnt_first_and_is_no_expression) {
  const ExpressionSettings settings;
  ExpressionState state;
  const FaceClasses sad = sure_of(FaceClass::sad, 0.5f), happy = sure_of(FaceClass::happy);
  double time = 0;
  for (; time < settings.learn + 2; time += 0.05) {
    const Expression shown = step_expression(state, settings, time, rest_face(), &sad);
    EXPECT_LT(shown.sadness, 0.05f) << time;
    if (time < settings.learn) {
      EXPECT_EQ(shown, Expression{}) << time;
    }
  }
  Expression shown;
  for (double end = time + 2; time < end; time += 0.05)
    shown = step_expression(state, settings, time, smiling(), &happy);
  EXPECT_GT(shown.joy, 0.6f);
  EXPECT_LT(shown.sadness, 0.1f);
}

// Learns a face at rest, then sees another one of which the network is sure.
Expression shown_after_rest(const FacePlane& face, FaceClass which) {
  const ExpressionSettings settings;
  ExpressionState state;
  const FaceClasses calm = sure_of(FaceClass::neutral), sure = sure_of(which);
  double time = 0;
  for (; time < settings.learn + 0.5; time += 0.05)
    step_expression(state, settings, time, rest_face(), &calm);
  for (double end = time + 2; time < end; time += 0.05)
    step_expression(state, settings, time, face, &sure);
  return state.shown;
}

TEST(Expression, the_network_is_not_believed_that_still_brows_are_surprised) {
  EXPECT_LT(shown_after_rest(rest_face(), FaceClass::surprised).surprise, 0.05f);
  EXPECT_GT(shown_after_rest(surprised(), FaceClass::surprised).surprise, 0.5f);
}

TEST(Expression, a_lifted_lip_is_disgust_and_not_anger) {
  FacePlane face = rest_face();
  for (size_t k = 17; k < 27; k++) face[k].y += 0.004f;
  const Expression angry = shown_after_rest(face, FaceClass::angry);
  EXPECT_GT(angry.anger, 0.3f);
  EXPECT_GT(angry.anger, angry.disgust + 0.2f);
  for (size_t k = 49; k < 54; k++) face[k].y -= 0.005f;
  for (size_t k = 61; k < 64; k++) face[k].y -= 0.005f;
  const Expression disgusted = shown_after_rest(face, FaceClass::disgusted);
  EXPECT_GT(disgusted.disgust, disgusted.anger + 0.2f);
}

TEST(Expression, a_mouth_that_opens_takes_its_corners_down_without_sadness) {
  FacePlane face = rest_face();
  for (size_t k : {66u, 57u, 8u}) face[k].y += 0.020f;
  for (size_t k : {48u, 54u, 60u, 64u}) face[k].y += 0.008f;
  EXPECT_LT(expression_of(*measure_faps(rest_face(), face)).sadness, 0.05f);
  for (size_t k : {66u, 57u, 8u}) face[k] = rest_face()[k];
  EXPECT_GT(expression_of(*measure_faps(rest_face(), face)).sadness, 0.3f);
}

TEST(Expression, nonsense_changes_nothing) {
  const ExpressionSettings settings;
  ExpressionState state;
  for (double time = 0; time < 4; time += 0.05)
    step_expression(state, settings, time, rest_face(), nullptr);
  FacePlane torn = rest_face();
  torn.fill(vec2(NAN));
  EXPECT_EQ(step_expression(state, settings, 4.1, torn, nullptr), state.shown);
  EXPECT_EQ(step_expression(state, settings, 1.0, smiling(), nullptr), Expression{});
}

}  // namespace
}  // namespace wellspring::test
