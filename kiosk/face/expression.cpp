// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/expression.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <opencv2/core.hpp>

#include "kiosk/face/expression_table.h"

namespace wellspring::kiosk {

namespace {

// Expression moves these points least: corners of the eyes, ridge and foot of the nose, temples.
constexpr size_t rigid[] = {33, 133, 362, 263, 168, 6, 197, 195, 5, 4, 2, 98, 327, 127, 356};
// These are the corners of the eyes, image left first.
constexpr size_t left_eye[] = {33, 133}, right_eye[] = {362, 263};
constexpr size_t nose_root = 168, nose_foot = 2;
static_assert(std::size(expression_table[0]) == cue_count);
constexpr float cue_of_classes = 0.5f;
constexpr double longest_step = 0.25;  // seconds

constexpr float Expression::*weights[] = {&Expression::joy,     &Expression::sadness,
                                          &Expression::anger,   &Expression::fear,
                                          &Expression::disgust, &Expression::surprise};
// valence and arousal
constexpr vec2 moods[] = {{0.81f, 0.51f},  {-0.63f, -0.27f}, {-0.51f, 0.59f},
                          {-0.64f, 0.60f}, {-0.60f, 0.35f},  {0.40f, 0.67f}};

// Brings one mesh onto another: out = scale * turn * (point - from) + to.
struct Fit {
  mat3 turn{1};
  float scale = 1;
  vec3 from{0}, to{0};
};

std::optional<Fit> fit_onto(const FaceMesh& mesh, const FaceMesh& rest) {
  Fit fit;
  for (size_t k : rigid) fit.from += mesh.points[k], fit.to += rest.points[k];
  fit.from /= float(std::size(rigid)), fit.to /= float(std::size(rigid));
  cv::Matx33d cross = cv::Matx33d::zeros();
  double size = 0, wanted = 0;
  for (size_t k : rigid) {
    const vec3 a = mesh.points[k] - fit.from, b = rest.points[k] - fit.to;
    size += glm::dot(a, a), wanted += glm::dot(b, b);
    for (int row = 0; row < 3; row++)
      for (int column = 0; column < 3; column++) cross(row, column) += b[row] * a[column];
  }
  if (!std::isfinite(size) || !std::isfinite(wanted) || !(size > 1) || !(wanted > 1)) return {};
  cv::Matx31d values;
  cv::Matx33d u, vt;
  cv::SVD::compute(cross, values, u, vt);
  const bool mirrored = cv::determinant(u * vt) < 0;
  const cv::Matx33d turn = u * cv::Matx33d::diag({1, 1, mirrored ? -1. : 1.}) * vt;
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++) fit.turn[column][row] = float(turn(row, column));
  fit.scale = float((values(0) + values(1) + (mirrored ? -1 : 1) * values(2)) / size);
  return fit;
}

FaceMesh moved_by(const Fit& fit, const FaceMesh& mesh) {
  FaceMesh out = mesh;
  for (vec3& point : out.points) point = fit.scale * (fit.turn * (point - fit.from)) + fit.to;
  return out;
}

vec3 mean_of(const FaceMesh& mesh, std::initializer_list<size_t> points) {
  vec3 sum{0};
  for (size_t k : points) sum += mesh.points[k];
  return sum / float(points.size());
}

}  // namespace

std::optional<FaceMesh> align(const FaceMesh& mesh, const FaceMesh& rest) {
  const auto fit = fit_onto(mesh, rest);
  return fit ? std::optional(moved_by(*fit, mesh)) : std::nullopt;
}

std::optional<FaceMovement> measure_movement(const FaceMesh& rest, const FaceMesh& now) {
  const auto fit = fit_onto(now, rest);
  if (!fit) return {};
  const FaceMesh face = moved_by(*fit, now);
  // Axes of the face at rest: to image right, up.
  const vec3 across =
      mean_of(rest, {right_eye[0], right_eye[1]}) - mean_of(rest, {left_eye[0], left_eye[1]});
  const float apart = glm::length(across);
  const vec3 right = across / apart;
  vec3 up = rest.points[nose_root] - rest.points[nose_foot];
  up -= glm::dot(up, right) * right;
  up /= glm::length(up);
  auto moved = [&](vec3 axis, std::initializer_list<size_t> points) {
    return 10 * glm::dot(mean_of(face, points) - mean_of(rest, points), axis) / apart;
  };
  auto apart_by = [&](size_t image_left, size_t image_right) {
    return (moved(right, {image_right}) - moved(right, {image_left})) / 2;
  };
  FaceMovement out;
  auto at = [&](Movement m) -> float& { return out.by[size_t(m)]; };
  at(Movement::inner_brows_up) = moved(up, {55, 285});
  at(Movement::brows_up) = moved(up, {52, 282, 105, 334});
  at(Movement::outer_brows_up) = moved(up, {70, 300, 46, 276});
  at(Movement::brows_together) = -apart_by(55, 285);
  at(Movement::mouth_wider) = apart_by(61, 291);
  at(Movement::corners_up) = moved(up, {61, 291});
  at(Movement::inner_upper_lip_up) = moved(up, {13});
  at(Movement::inner_lower_lip_up) = moved(up, {14});
  at(Movement::upper_lip_up) = moved(up, {0});
  at(Movement::lower_lip_up) = moved(up, {17});
  at(Movement::jaw_down) = -moved(up, {152});
  at(Movement::upper_lids_up) = moved(up, {159, 386});
  at(Movement::lower_lids_up) = moved(up, {145, 374});
  at(Movement::nose_up) = moved(up, {129, 358});
  at(Movement::sides_of_upper_lip_up) = moved(up, {37, 267, 39, 269});
  at(Movement::cheeks_up) = moved(up, {50, 280});
  at(Movement::eyes_open) = at(Movement::upper_lids_up) - at(Movement::lower_lids_up);
  const mat3& turn = fit->turn;
  out.turned = {(turn[1][2] - turn[2][1]) / 2, (turn[2][0] - turn[0][2]) / 2};
  for (float movement : out.by)
    if (!std::isfinite(movement)) return {};
  return out;
}

Cues cues_of(const FaceMovement& movement, const FaceClasses& usual, const FaceClasses& classes) {
  Cues cues{};
  auto next = std::copy(movement.by.begin(), movement.by.end(), cues.begin());
  for (size_t c = 0; c < classes.size(); c++) *next++ = cue_of_classes * (classes[c] - usual[c]);
  const auto [pitch, yaw] = std::pair(movement.turned.x, movement.turned.y);
  for (float turn : {pitch, std::abs(yaw), 2 * pitch * pitch, 2 * yaw * yaw}) *next++ = turn;
  return cues;
}

Expression expression_of(const Cues& cues) {
  Expression out;
  for (size_t e = 0; e < std::size(weights); e++) {
    float sum = 0;
    for (size_t k = 0; k < cues.size(); k++) sum += expression_table[e][k] * cues[k];
    out.*weights[e] = std::clamp(sum, 0.f, 1.f);
  }
  tell_mood(out);
  return out;
}

void tell_mood(Expression& expression) {
  vec2 mood{0};
  float sum = 0;
  for (size_t e = 0; e < std::size(weights); e++)
    mood += expression.*weights[e] * moods[e], sum += expression.*weights[e];
  mood /= std::max(1.f, sum);
  expression.valence = mood.x, expression.arousal = mood.y;
}

Expression step_expression(ExpressionState& state, const ExpressionSettings& settings, double time,
                           const FaceMesh& face, const FaceClasses* classes) {
  const double step = std::clamp(time - state.time, 0.0, longest_step);
  state.time = time;
  if (classes) state.classes = *classes, state.read_time = time;
  if (!state.rest) {
    if (!measure_movement(face, face)) return state.shown;
    state.rest = face;
    state.usual = state.classes;
    return state.shown;
  }
  if (state.learnt < settings.learn) {
    const auto aligned = align(face, *state.rest);
    if (!aligned) return state.shown;
    // Rest is the mean of all faces so far.
    state.learnt += step;
    const float share = state.learnt > 0 ? float(step / state.learnt) : 0;
    for (size_t k = 0; k < mesh_points; k++)
      state.rest->points[k] += share * (aligned->points[k] - state.rest->points[k]);
    for (size_t c = 0; c < state.usual.size(); c++)
      state.usual[c] += share * (state.classes[c] - state.usual[c]);
    return state.shown;
  }
  const auto movement = measure_movement(*state.rest, face);
  if (!movement) return state.shown;
  const Expression now = expression_of(cues_of(*movement, state.usual, state.classes));
  const float pull = float(1 - std::exp(-step / settings.smooth));
  for (float Expression::*weight : weights)
    state.shown.*weight += pull * (now.*weight - state.shown.*weight);
  tell_mood(state.shown);
  return state.shown;
}

}  // namespace wellspring::kiosk
