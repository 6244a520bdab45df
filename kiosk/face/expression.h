// SPDX-License-Identifier: Apache-2.0
// Reads what a visitor's face seems to express, as six weights: seven classes by a network, joined
// with how the face has moved from its own rest (FAPs). A face's rest is learnt in the first
// seconds somebody is seen and forgotten with the person's number; nothing is stored. These are
// guesses from smiles, brows and lids, not what anybody feels; docs/benchmarks/kiosk.expression.md
// says how often they are right for drawn figures. It is off unless asked for, since people must be
// told of it.
#pragma once
#include <array>
#include <optional>

#include "kiosk/face/head_pose.h"
#include "kiosk/network/face_marks.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

// Measures movements of a face in MPEG-4's terms (ISO/IEC 14496-2, annex C): landmarks are its
// feature points, and each movement is a facial animation parameter (FAP), measured in units of the
// face's own distances (FAPU), so that it means the same on any face.

// Holds landmarks in the plane of the face, metres: x to the picture's right when the face looks
// into the lens, y down; each on its depth in the model, with the head's pose taken out.
using FacePlane = std::array<vec2, landmark_count>;
FacePlane face_plane(const FaceMarks& marks, const HeadPose& pose, float focal, int width,
                     int height);

// Holds FAPs by their number in the standard (1 to 68); those that landmarks do not show stay 0.
//   3 open jaw; 4, 5 inner lips up and down; 6, 7 stretch and 12, 13 raise their corners;
//   19-22 close the lids; 31-36 raise the brows; 37, 38 squeeze them; 53, 54 stretch and 59, 60
//   raise the outer corners of the lips
using Faps = std::array<float, 69>;

// Measures FAPs of `now` against the same face at rest; 0 for parts that do not move. Movement of
// the whole face is taken out by its eyes' corners and its nose. Returns nothing if `rest` is no
// face or a number is not finite.
std::optional<Faps> measure_faps(const FacePlane& rest, const FacePlane& now);

struct ExpressionSettings {
  double learn = 2;         // seconds in which a face's rest is learnt
  double read_every = 0.2;  // seconds between looks of the network at one person
  double smooth = 0.4;      // seconds in which the weights go two thirds of the way
};

// This is the state of one person, from first sight on.
struct ExpressionState {
  double learnt = 0, time = -1e9, read_time = -1e9;  // seconds
  FacePlane rest{};
  FaceClasses usual{}, classes{};  // means while learning; the network's last answer
  Expression shown;
};

// Returns the evidence of FAPs alone, 0..1 each (after Raouzaiou et al., "Parameterized facial
// expression synthesis based on MPEG-4", 2002, table 1: which FAPs go with which expression).
Expression expression_of(const Faps& faps);

// Takes one frame: `face` as face_plane gives it, `classes` if the network was asked in this frame.
// Times that run backwards count as no time. Returns state.shown; all 0 while rest is learnt.
Expression step_expression(ExpressionState& state, const ExpressionSettings& settings, double time,
                           const FacePlane& face, const FaceClasses* classes);

}  // namespace wellspring::kiosk
