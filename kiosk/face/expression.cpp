// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/expression.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr float share_of_faps = 0.4f;  // of the joined weight; the rest is the network's
// FAP units of brows from which the network is believed that calls a face afraid or surprised: it
// does so of faces that only look up, too.
constexpr float brows_still = 15, brows_moved = 45;
constexpr float most_usual = 0.5f;     // a class cannot be more usual than this
constexpr double longest_step = 0.25;  // seconds

// How far evidence goes from 0 at `none` to 1 at `full` FAP units; full may be below none.
float reach(float value, float none, float full) {
  return std::clamp((value - none) / (full - none), 0.f, 1.f);
}

constexpr float Expression::*weights[] = {&Expression::joy,     &Expression::sadness,
                                          &Expression::anger,   &Expression::fear,
                                          &Expression::disgust, &Expression::surprise};
constexpr FaceClass classes_of[] = {FaceClass::happy,   FaceClass::sad,       FaceClass::angry,
                                    FaceClass::fearful, FaceClass::disgusted, FaceClass::surprised};

float raised_brows(const Faps& f) { return (f[31] + f[32] + f[33] + f[34] + f[35] + f[36]) / 6; }

// Two classes that the network takes for one another: what it says of both together, shared half
// as it says and half by what tells them apart, 0 (the first) to 1 (the second).
void share_between(float& first, float& second, float evidence) {
  const float both = first + second;
  if (!(both > 0)) return;
  second = both * (second / both + evidence) / 2;
  first = both - second;
}

// What the network sees that is not so at rest, with what FAPs know better.
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
    // The mean of all faces so far.
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
