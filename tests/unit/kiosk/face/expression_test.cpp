// SPDX-License-Identifier: Apache-2.0
// Expressions of a made mesh: what moves is measured however the head is turned, and what it means.
#include "kiosk/face/expression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"

namespace wellspring::test {
namespace {

using namespace kiosk;

// A bowl of points; those that are measured lie about where a face has them, pixels.
FaceMesh rest_face() {
  FaceMesh face;
  Rng random(11);
  for (vec3& point : face.points)
    point = {200 * random.uniform() - 100, 240 * random.uniform() - 120, 20 * random.uniform()};
  const std::pair<size_t, vec3> places[] = {
      {33, {-45, 0, 10}},   {133, {-16, 2, 5}},   {362, {16, 2, 5}},    {263, {45, 0, 10}},
      {168, {0, -2, -12}},  {6, {0, 6, -16}},     {197, {0, 14, -20}},  {195, {0, 22, -24}},
      {5, {0, 30, -28}},    {4, {0, 38, -31}},    {2, {0, 47, -13}},    {98, {-12, 45, -8}},
      {327, {12, 45, -8}},  {127, {-69, -4, 60}}, {356, {69, -4, 60}},  {55, {-15, -19, -6}},
      {285, {15, -19, -6}}, {52, {-30, -24, 0}},  {282, {30, -24, 0}},  {105, {-35, -25, 0}},
      {334, {35, -25, 0}},  {70, {-50, -18, 10}}, {300, {50, -18, 10}}, {46, {-48, -14, 10}},
      {276, {48, -14, 10}}, {61, {-26, 68, 0}},   {291, {26, 68, 0}},   {13, {0, 67, -12}},
      {14, {0, 70, -12}},   {0, {0, 61, -15}},    {17, {0, 78, -12}},   {152, {0, 114, -6}},
      {159, {-30, -5, 3}},  {386, {30, -5, 3}},   {145, {-30, 6, 3}},   {374, {30, 6, 3}},
      {129, {-15, 44, -6}}, {358, {15, 44, -6}},  {37, {-6, 62, -14}},  {267, {6, 62, -14}},
      {39, {-12, 63, -12}}, {269, {12, 63, -12}}, {50, {-45, 40, 10}},  {280, {45, 40, 10}}};
  for (const auto& [point, place] : places) face.points[point] = place;
  return face;
}

void move(FaceMesh& face, std::initializer_list<size_t> points, vec2 by) {
  for (size_t k : points) face.points[k] += vec3(by, 0);
}
// Moves the corners of the mouth up and out, as a smile does, and the cheeks with them.
FaceMesh smiling() {
  FaceMesh face = rest_face();
  move(face, {61}, {-5, -6}), move(face, {291}, {5, -6});
  move(face, {13, 37, 267, 39, 269, 0}, {0, -4}), move(face, {50, 280}, {0, -2});
  return face;
}
FaceMesh surprised() {
  FaceMesh face = rest_face();
  move(face, {55, 285, 52, 282, 105, 334, 70, 300, 46, 276}, {0, -6});
  move(face, {152}, {0, 6}), move(face, {14, 17}, {0, 8}), move(face, {61, 291}, {0, 5});
  move(face, {13, 0, 37, 267, 39, 269}, {0, 4}), move(face, {129, 358, 50, 280}, {0, 2});
  return face;
}
// Turns, enlarges and shifts a face: another place before the camera.
FaceMesh elsewhere(FaceMesh face, float angle) {
  for (vec3& p : face.points) {
    const vec3 turned{std::cos(angle) * p.x + std::sin(angle) * p.z, p.y,
                      std::cos(angle) * p.z - std::sin(angle) * p.x};
    p = 1.7f * turned + vec3(320, 200, 0);
  }
  return face;
}
float moved(const FaceMesh& face, Movement movement) {
  return measure_movement(rest_face(), face)->by[size_t(movement)];
}
FaceClasses sure_of(FaceClass which, float by = 0.9f) {
  FaceClasses classes;
  classes.fill((1 - by) / 6);
  classes[size_t(which)] = by;
  return classes;
}

TEST(Expression, NothingMovesInAFaceAtRestWhereverItIs) {
  for (float angle : {0.f, 0.4f, -0.8f}) {
    const auto movement = measure_movement(rest_face(), elsewhere(rest_face(), angle));
    ASSERT_TRUE(movement);
    for (float by : movement->by) EXPECT_NEAR(by, 0, 1e-3f) << angle;
    EXPECT_NEAR(std::abs(movement->turned.y), std::sin(std::abs(angle)), 1e-4f);
    EXPECT_NEAR(movement->turned.x, 0, 1e-4f);
  }
}

TEST(Expression, MovementsAreTenthsOfTheDistanceBetweenTheEyes) {
  const float apart = 61;  // pixels in rest_face
  for (float angle : {0.f, 0.5f}) {
    const FaceMesh face = elsewhere(smiling(), angle);
    EXPECT_NEAR(moved(face, Movement::corners_up), 10 * 6 / apart, 0.01f);
    EXPECT_NEAR(moved(face, Movement::mouth_wider), 10 * 5 / apart, 0.01f);
    EXPECT_NEAR(moved(face, Movement::cheeks_up), 10 * 2 / apart, 0.01f);
    EXPECT_NEAR(moved(face, Movement::brows_up), 0, 0.01f);
  }
  EXPECT_NEAR(moved(surprised(), Movement::inner_brows_up), 10 * 6 / apart, 0.01f);
  EXPECT_NEAR(moved(surprised(), Movement::jaw_down), 10 * 6 / apart, 0.01f);
  EXPECT_LT(moved(surprised(), Movement::inner_lower_lip_up), -1);
}

TEST(Expression, WhatIsNoFaceHasNoMovements) {
  FaceMesh flat, torn = rest_face();
  torn.points[33].x = NAN;
  EXPECT_FALSE(measure_movement(flat, rest_face()));
  EXPECT_FALSE(measure_movement(rest_face(), flat));
  EXPECT_FALSE(measure_movement(rest_face(), torn));
  EXPECT_FALSE(align(torn, rest_face()));
}

Expression read(const FaceMesh& face, FaceClass seen) {
  const FaceClasses usual = sure_of(FaceClass::neutral);
  return expression_of(cues_of(*measure_movement(rest_face(), face), usual, sure_of(seen)));
}

TEST(Expression, MovementsAndClassesAgreeOnIt) {
  const Expression joy = read(smiling(), FaceClass::happy);
  EXPECT_GT(joy.joy, 0.5f);
  EXPECT_LT(std::max({joy.sadness, joy.anger, joy.fear, joy.surprise}), 0.3f);
  EXPECT_GT(*joy.valence, 0.3f);
  EXPECT_GT(*joy.arousal, 0.2f);
  const Expression surprise = read(surprised(), FaceClass::surprised);
  EXPECT_GT(surprise.surprise, 0.5f);
  EXPECT_LT(std::max({surprise.joy, surprise.sadness, surprise.anger, surprise.disgust}),
            surprise.surprise - 0.2f);
  const Expression rest = read(rest_face(), FaceClass::neutral);
  EXPECT_LT(std::max({rest.joy, rest.sadness, rest.anger, rest.fear, rest.disgust, rest.surprise}),
            1e-3f);
}

TEST(Expression, MoodIsAMeanByWeights) {
  Expression sad{.sadness = 1}, both{.joy = 1, .sadness = 1};
  tell_mood(sad), tell_mood(both);
  EXPECT_NEAR(*sad.valence, -0.63f, 1e-6f);
  EXPECT_NEAR(*sad.arousal, -0.27f, 1e-6f);
  EXPECT_NEAR(*both.valence, (0.81f - 0.63f) / 2, 1e-6f);
}

// A face whose rest the network takes for sad is not sad; when it smiles, joy rises.
TEST(Expression, RestIsLearntFirstAndIsNoExpression) {
  const ExpressionSettings settings;
  ExpressionState state;
  const FaceClasses sad = sure_of(FaceClass::sad, 0.5f), happy = sure_of(FaceClass::happy);
  double time = 0;
  for (; time < settings.learn + 2; time += 0.05) {
    const FaceMesh face = elsewhere(rest_face(), float(0.1 * std::sin(time)));
    const Expression shown = step_expression(state, settings, time, face, &sad);
    EXPECT_LT(shown.sadness, 0.05f) << time;
    if (time < settings.learn) {
      EXPECT_EQ(shown, Expression{}) << time;
    }
  }
  Expression shown;
  for (double end = time + 2; time < end; time += 0.05)
    shown = step_expression(state, settings, time, smiling(), &happy);
  EXPECT_GT(shown.joy, 0.5f);
  EXPECT_LT(shown.sadness, 0.1f);
}

TEST(Expression, NonsenseChangesNothing) {
  const ExpressionSettings settings;
  ExpressionState state;
  FaceMesh torn = rest_face();
  torn.points.fill(vec3(NAN));
  EXPECT_EQ(step_expression(state, settings, 0, torn, nullptr), Expression{});
  for (double time = 0.05; time < 4; time += 0.05)
    step_expression(state, settings, time, rest_face(), nullptr);
  const Expression before = state.shown;
  EXPECT_EQ(step_expression(state, settings, 4.1, torn, nullptr), before);
  EXPECT_EQ(step_expression(state, settings, 1.0, smiling(), nullptr), before);
}

}  // namespace
}  // namespace wellspring::test
