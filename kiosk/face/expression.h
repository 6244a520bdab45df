// SPDX-License-Identifier: Apache-2.0
// What a visitor's face seems to express, as six weights: seven classes by a network, joined with
// how the face has moved from its own rest (FAPs). What a face looks like at rest is learnt in the
// first seconds somebody is seen and forgotten with the person's number; nothing is stored.
// These are guesses from smiles, brows and lids, not what anybody feels; how often they are right
// of drawn figures is in docs/benchmarks/kiosk.expression.md. Off unless asked for, since people
// must be told of it.
#pragma once
#include "kiosk/face/fap.h"
#include "kiosk/network/face_marks.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

struct ExpressionSettings {
  double learn = 2;         // seconds in which a face's rest is learnt
  double read_every = 0.2;  // seconds between looks of the network at one person
  double smooth = 0.4;      // seconds in which the weights go two thirds of the way
};

// One person's, from first sight on.
struct ExpressionState {
  double learnt = 0, time = -1e9, read_time = -1e9;  // seconds
  FacePlane rest{};
  FaceClasses usual{}, classes{};  // means while learning; what the network said last
  Expression shown;
};

// Evidence of FAPs alone, 0..1 each (after Raouzaiou et al., "Parameterized facial expression
// synthesis based on MPEG-4", 2002, table 1: which FAPs go with which expression).
Expression expression_of(const Faps& faps);

// One frame: `face` as face_plane gives it, `classes` where the network was asked in this frame.
// Times that run backwards count as no time. Returns state.shown; all 0 while rest is learnt.
Expression step_expression(ExpressionState& state, const ExpressionSettings& settings, double time,
                           const FacePlane& face, const FaceClasses* classes);

}  // namespace wellspring::kiosk
