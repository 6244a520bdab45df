// SPDX-License-Identifier: Apache-2.0
// Reads what a visitor's face seems to express, as six weights: by how the face's mesh has moved
// from its own rest, joined with seven classes by a network. A face's rest is learnt in the first
// seconds somebody is seen and forgotten with the person's number; nothing is stored. These are
// guesses from smiles, brows and lids, not what anybody feels; docs/benchmarks/kiosk.expression.md
// says how often they are right for drawn figures. It is off unless asked for, since people must be
// told of it.
#pragma once
#include <array>
#include <optional>

#include "kiosk/face/face_mesh.h"
#include "kiosk/network/face_marks.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

// Measures movements of a face in MPEG-4's terms (ISO/IEC 14496-2, annex C): each is a facial
// animation parameter (FAP), the mean of both sides, in tenths of the distance between the eyes, so
// that it means the same on any face.
enum class Movement : uint8_t {
  inner_brows_up,         // FAPs 31, 32
  brows_up,               // 33, 34
  outer_brows_up,         // 35, 36
  brows_together,         // 37, 38
  mouth_wider,            // 53, 54
  corners_up,             // 59, 60
  inner_upper_lip_up,     // 4, downwards there
  inner_lower_lip_up,     // 5
  upper_lip_up,           // 51, downwards there
  lower_lip_up,           // 52
  jaw_down,               // 3
  upper_lids_up,          // 19, 20, downwards there
  lower_lids_up,          // 21, 22
  nose_up,                // 63, at its wings
  sides_of_upper_lip_up,  // 55, 56, downwards there
  cheeks_up,              // 41, 42
  eyes_open,              // upper lids against lower ones
};
inline constexpr size_t movement_count = 17;

struct FaceMovement {
  std::array<float, movement_count> by{};  // by Movement
  // Sines of how far the head is turned from where it was at rest: pitch and yaw. The network of
  // the mesh draws a turned face a little otherwise.
  vec2 turned{0};
};

// Returns `mesh` moved, turned and scaled so that its points that expression moves least lie on
// those of `rest` (least squares, by the singular values of Umeyama 1991). Nothing if either is no
// face.
std::optional<FaceMesh> align(const FaceMesh& mesh, const FaceMesh& rest);

// Measures how `now` differs from the same face at rest. Nothing if either is no face.
std::optional<FaceMovement> measure_movement(const FaceMesh& rest, const FaceMesh& now);

// A guess is linear in these: movements; half of how far classes are above those at rest, in the
// order of FaceClass; and turns, |yaw|, and squares of pitch and yaw.
inline constexpr size_t cue_count = movement_count + 7 + 4;
using Cues = std::array<float, cue_count>;
Cues cues_of(const FaceMovement& movement, const FaceClasses& usual, const FaceClasses& classes);

// Returns what cues say: 0..1 for each of the six, with valence and arousal. Factors are fitted to
// the project's figures (ridge regression, expression_table.h).
Expression expression_of(const Cues& cues);

// Sets valence and arousal, the mean of those of the six by their weights (Russell, Mehrabian,
// "Evidence for a three-factor theory of emotions", 1977, table 4); 0 for none.
void tell_mood(Expression& expression);

struct ExpressionSettings {
  double learn = 2;         // seconds in which a face's rest is learnt
  double read_every = 0.2;  // seconds between looks of the network at one person
  double smooth = 0.4;      // seconds in which the weights go two thirds of the way
};

// This is the state of one person, from first sight on.
struct ExpressionState {
  double learnt = 0, time = -1e9, read_time = -1e9;  // seconds
  std::optional<FaceMesh> rest;
  FaceClasses usual{}, classes{};  // means while learning; the network's last answer
  Expression shown;
};

// Takes one frame; `classes` if the network was asked in it. Times that run backwards count as no
// time. Returns state.shown; all 0 while rest is learnt.
Expression step_expression(ExpressionState& state, const ExpressionSettings& settings, double time,
                           const FaceMesh& face, const FaceClasses* classes);

}  // namespace wellspring::kiosk
