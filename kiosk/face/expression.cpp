// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/expression.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

// Expression moves these points least.
constexpr size_t rigid[] = {27, 28, 29, 30, 33, 36, 39, 42, 45};
constexpr float least_unit = 0.002f;  // metres: a face has no smaller distances

enum class Unit : uint8_t { eyes, eye_nose, mouth_nose, mouth, iris };

struct Rule {
  size_t fap, point;
  Unit unit;
  vec2 along;  // direction of positive values
};
constexpr vec2 up{0, -1}, down{0, 1}, image_left{-1, 0}, image_right{1, 0};
// The face's own left is at image right.
constexpr Rule rules[] = {
    {3, 8, Unit::mouth_nose, down},    {4, 62, Unit::mouth_nose, down},
    {5, 66, Unit::mouth_nose, up},     {6, 64, Unit::mouth, image_right},
    {7, 60, Unit::mouth, image_left},  {12, 64, Unit::mouth_nose, up},
    {13, 60, Unit::mouth_nose, up},    {31, 22, Unit::eye_nose, up},
    {32, 21, Unit::eye_nose, up},      {33, 24, Unit::eye_nose, up},
    {34, 19, Unit::eye_nose, up},      {35, 26, Unit::eye_nose, up},
    {36, 17, Unit::eye_nose, up},      {37, 22, Unit::eyes, image_left},
    {38, 21, Unit::eyes, image_right}, {53, 54, Unit::mouth, image_right},
    {54, 48, Unit::mouth, image_left}, {59, 54, Unit::mouth_nose, up},
    {60, 48, Unit::mouth_nose, up},
};
// Lids have two points each.
struct LidRule {
  size_t fap, a, b;
  vec2 along;
};
constexpr LidRule lids[] = {
    {19, 43, 44, down}, {20, 37, 38, down}, {21, 46, 47, up}, {22, 40, 41, up}};

vec2 middle(const FacePlane& face, size_t from, size_t count) {
  vec2 sum{0};
  for (size_t k = from; k < from + count; k++) sum += face[k];
  return sum / float(count);
}

// Returns `now` moved, turned and scaled so that its rigid points lie on those of `rest` (least
// squares).
FacePlane aligned(const FacePlane& rest, const FacePlane& now) {
  vec2 from{0}, to{0};
  for (size_t k : rigid) from += now[k], to += rest[k];
  from /= float(std::size(rigid)), to /= float(std::size(rigid));
  float same = 0, cross = 0, size = 0;
  for (size_t k : rigid) {
    const vec2 a = now[k] - from, b = rest[k] - to;
    same += glm::dot(a, b), cross += a.x * b.y - a.y * b.x, size += glm::dot(a, a);
  }
  const float c = same / size, s = cross / size;
  FacePlane out;
  for (size_t k = 0; k < now.size(); k++) {
    const vec2 a = now[k] - from;
    out[k] = to + vec2(c * a.x - s * a.y, s * a.x + c * a.y);
  }
  return out;
}

}  // namespace

FacePlane face_plane(const FaceMarks& marks, const HeadPose& pose, float focal, int width,
                     int height) {
  FacePlane out;
  const mat3 back = glm::transpose(pose.rotation);
  const vec3 eye = back * -pose.position;  // the lens, seen from the head
  for (size_t k = 0; k < marks.size(); k++) {
    const vec3 ray = back * vec3((marks[k].x - float(width) / 2) / focal,
                                 (marks[k].y - float(height) / 2) / focal, 1);
    const float t = (face_point(k).z - eye.z) / ray.z;
    const vec3 p = eye + t * ray;
    out[k] = {p.x, p.y};
  }
  return out;
}

std::optional<Faps> measure_faps(const FacePlane& rest, const FacePlane& now) {
  const float units[] = {
      glm::length(middle(rest, 42, 6) - middle(rest, 36, 6)),
      rest[33].y - (middle(rest, 36, 6).y + middle(rest, 42, 6).y) / 2,
      rest[62].y - rest[33].y,
      glm::length(rest[54] - rest[48]),
      (middle(rest, 40, 2).y + middle(rest, 46, 2).y - middle(rest, 37, 2).y -
       middle(rest, 43, 2).y) /
          2,
  };
  for (float unit : units)
    if (!(unit > least_unit) || !std::isfinite(unit)) return {};
  const FacePlane face = aligned(rest, now);
  Faps faps{};
  auto unit = [&](Unit u) { return units[size_t(u)] / 1024; };
  for (const Rule& r : rules)
    faps[r.fap] = glm::dot(face[r.point] - rest[r.point], r.along) / unit(r.unit);
  for (const LidRule& r : lids)
    faps[r.fap] =
        glm::dot(face[r.a] + face[r.b] - rest[r.a] - rest[r.b], r.along) / 2 / unit(Unit::iris);
  for (float fap : faps)
    if (!std::isfinite(fap)) return {};
  return faps;
}

namespace {

constexpr float share_of_faps = 0.4f;  // share of the joined weight; the rest is the network's
// FAP units of brows: the network is believed from these on when it calls a face afraid or
// surprised, since it does so of faces that only look up, too.
constexpr float brows_still = 15, brows_moved = 45;
constexpr float most_usual = 0.5f;     // no class can be more usual than this
constexpr double longest_step = 0.25;  // seconds

// Returns how far evidence goes from 0 at `none` to 1 at `full` FAP units; full may be below none.
float reach(float value, float none, float full) {
  return std::clamp((value - none) / (full - none), 0.f, 1.f);
}

constexpr float Expression::*weights[] = {&Expression::joy,     &Expression::sadness,
                                          &Expression::anger,   &Expression::fear,
                                          &Expression::disgust, &Expression::surprise};
constexpr FaceClass classes_of[] = {FaceClass::happy,   FaceClass::sad,       FaceClass::angry,
                                    FaceClass::fearful, FaceClass::disgusted, FaceClass::surprised};

float raised_brows(const Faps& f) { return (f[31] + f[32] + f[33] + f[34] + f[35] + f[36]) / 6; }

// Shares the weight of two classes that the network confuses: half as the network shares it, half
// by evidence between them, 0 (the first) to 1 (the second).
void share_between(float& first, float& second, float evidence) {
  const float both = first + second;
  if (!(both > 0)) return;
  second = both * (second / both + evidence) / 2;
  first = both - second;
}

// Returns what the network sees beyond the face at rest, corrected by FAPs where they are better.
FaceClasses unusual_classes(const FaceClasses& classes, const FaceClasses& usual, const Faps& f) {
  FaceClasses out{};
  for (size_t c = 0; c < classes.size(); c++) {
    const float before = std::min(usual[c], most_usual);
    out[c] = std::max(0.f, (classes[c] - before) / (1 - before));
  }
  auto of = [&](FaceClass c) -> float& { return out[size_t(c)]; };
  // Surprise rounds the mouth, disgust lifts the upper lip.
  share_between(of(FaceClass::fearful), of(FaceClass::surprised),
                reach(-(f[53] + f[54]) / 2, 10, 40));
  share_between(of(FaceClass::angry), of(FaceClass::disgusted), reach(-f[4], 30, 90));
  const float moved = reach(raised_brows(f), brows_still, brows_moved);
  of(FaceClass::fearful) *= moved, of(FaceClass::surprised) *= moved;
  return out;
}

}  // namespace

Expression expression_of(const Faps& f) {
  const float corners = (f[59] + f[60]) / 2, stretch = (f[53] + f[54]) / 2;
  // An opening mouth takes its corners down with it; sadness does more.
  const float middle = std::min(0.f, (f[5] - f[4]) / 2);
  const float inner = (f[31] + f[32]) / 2, outer = (f[35] + f[36]) / 2, mid = (f[33] + f[34]) / 2;
  const float squeeze = (f[37] + f[38]) / 2, lids = (f[19] + f[20]) / 2, jaw = f[3];
  const float upper_lip = -f[4];
  const float raised = reach(raised_brows(f), 40, 150);
  const float lowered = reach((inner + mid) / 2, -30, -120);
  const float wide = reach(lids, -60, -300), open = reach(jaw, 60, 500);
  Expression out;
  out.joy = std::min(reach(corners, 50, 250), 0.4f + 0.6f * reach(stretch, 10, 120));
  out.sadness =
      std::min(reach(corners - middle, -40, -180), 0.5f + 0.5f * reach(inner - outer, 20, 120));
  out.anger = lowered * (0.8f + 0.2f * reach(squeeze, 15, 90)) * (1 - open);
  out.disgust = reach(upper_lip, 60, 250) * lowered;
  out.surprise = raised * (0.3f + 0.7f * open);
  out.fear = std::min({raised, wide, 0.4f + 0.6f * reach(stretch, 10, 120)}) * (1 - 0.5f * open);
  return out;
}

Expression step_expression(ExpressionState& state, const ExpressionSettings& settings, double time,
                           const FacePlane& face, const FaceClasses* classes) {
  const double step = std::clamp(time - state.time, 0.0, longest_step);
  const bool first = state.time < -1e8;
  state.time = time;
  if (classes) state.classes = *classes, state.read_time = time;
  for (const vec2& p : face)
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return state.shown;
  if (first) {
    state.rest = face;
    state.usual = state.classes;
    return state.shown;
  }
  if (state.learnt < settings.learn) {
    // Rest is the mean of all faces so far.
    state.learnt += step;
    const float share = state.learnt > 0 ? float(step / state.learnt) : 0;
    for (size_t k = 0; k < face.size(); k++) state.rest[k] += share * (face[k] - state.rest[k]);
    for (size_t c = 0; c < state.usual.size(); c++)
      state.usual[c] += share * (state.classes[c] - state.usual[c]);
    return state.shown;
  }
  const auto faps = measure_faps(state.rest, face);
  if (!faps) return state.shown;
  const Expression moved = expression_of(*faps);
  const FaceClasses unusual = unusual_classes(state.classes, state.usual, *faps);
  const float pull = float(1 - std::exp(-step / settings.smooth));
  for (size_t k = 0; k < std::size(weights); k++) {
    const float joined =
        (1 - share_of_faps) * unusual[size_t(classes_of[k])] + share_of_faps * moved.*weights[k];
    float& shown = state.shown.*weights[k];
    shown = std::clamp(shown + pull * (joined - shown), 0.f, 1.f);
  }
  return state.shown;
}

}  // namespace wellspring::kiosk
