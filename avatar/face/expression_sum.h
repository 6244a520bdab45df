// SPDX-License-Identifier: Apache-2.0
// The algebra of expressions: sums of weighted expressions over a figure, and what is done with
// them.
//
// A sum has one number a control and one a rotator. Adding is linear, so it is commutative, has the
// empty sum as identity, and weights that cancel leave nothing. Bounds are put on once, when a sum
// is applied; clamping in between would make the result depend on the order. docs/expressions.md
// writes the laws down, tests/unit/avatar/face/expression_algebra_test.cpp draws random sums
// against them.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "avatar/face/emotion.h"
#include "avatar/face/expression.h"
#include "avatar/face/perlin_face.h"
#include "avatar/figure/pose.h"

namespace wellspring::avatar {

// A set as one figure can show it. Made once for each figure; everything nested is flattened.
struct ExpressionRig {
  const ExpressionSet* set = nullptr;                  // borrowed
  std::vector<std::vector<ExpressionPart>> controls;   // of each expression
  std::vector<std::vector<ExpressionPart>> rotations;  // of each expression: rotators
  struct Drive {
    int displacer = -1, rotator = -1;  // both -1: the figure lacks the control
    float scale = 1;
  };
  std::vector<Drive> drives;                 // of each control
  std::vector<int> joints;                   // of each rotator; -1: the figure lacks it
  std::array<int, emotion_count> emotion{};  // expressions by their names, -1: none
  std::array<int, 15> viseme{};              // in the order of Viseme
  int breathe = -1;
  std::array<std::array<std::array<int, 2>, 2>, flex_count> flex;  // of [left, right][minus, plus]
  std::vector<std::string> missing;  // expressions that the figure has nothing to show with
};
ExpressionRig make_expression_rig(const ExpressionSet& set, const Character& character);
// Whether the figure shows anything of an expression.
bool shows(const ExpressionRig& rig, int expression);

struct ExpressionSum {
  std::vector<float> controls, rotators;
};
// The identity: nothing is asked for.
void clear(ExpressionSum& sum, const ExpressionRig& rig);
// sum += weight * expression. Unknown expressions (-1) and weights that are not finite add nothing.
void add(ExpressionSum& sum, const ExpressionRig& rig, int expression, float weight);
// sum += weight * other.
void add(ExpressionSum& sum, const ExpressionSum& other, float weight);
// The weighted mean; weights that sum to nothing give the empty sum.
ExpressionSum mean(const ExpressionRig& rig, const std::vector<ExpressionSum>& sums,
                   const std::vector<float>& weights);

// What must not be lost in a sum, after all layers are in.
struct Protected {
  std::array<float, 2> closing{0, 0};  // of the blink, 0..1
  std::array<float, 15> visemes{};     // of the speech, 0..1
  float talking = 0;                   // 0..1: the mouth belongs to the words
};
// Adds speech and blink so that nothing else keeps lips or lids from closing: where a bilabial is
// at 1 no control that parts the lips is left, where a blink is at 1 the lids are shut whatever the
// layers say.
void protect(ExpressionSum& sum, const ExpressionRig& rig, const Protected& what);

// Turns joints by the sum of their rotators' rotation vectors, over their pose. Before the eyes are
// aimed, since heads turn.
void apply_rotators(const ExpressionSum& sum, const ExpressionRig& rig, Pose& pose);
// Clamps the controls to 0..1 and writes them into displacers (overwritten where the set controls
// them), or into the lids and jaws of figures that have joints instead.
void apply_controls(const ExpressionSum& sum, const ExpressionRig& rig, Pose& pose);

// ---- emotions, before they become a face ----

// a + weight b, without bounds. Terms that are not finite add nothing.
Emotions add(const Emotions& a, const Emotions& b, float weight);
Emotions mix(const Emotions& a, const Emotions& b, float t);
// What a face can show of a sum of layers: opposites cancel (joy and sadness, anger and fear), each
// is within 0..1, and all together weigh at most 1, so that no mixture becomes a grimace.
Emotions bounded(const Emotions& sum);

}  // namespace wellspring::avatar
