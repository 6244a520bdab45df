// SPDX-License-Identifier: Apache-2.0
// Sums weighted expressions over a figure, and applies the sums to it: the algebra of expressions.
//
// A sum has one number a control and one a rotator. Adding is linear, so it is commutative, has the
// empty sum as identity, and weights that cancel leave nothing. Bounds are put on once, when a sum
// is applied; clamping in between would make the result depend on the order. docs/expressions.md
// writes the laws down, tests/unit/avatar/face/expression_algebra_test.cpp draws random sums
// against them.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "avatar/face/expression.h"
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// Moves Perlin's responsive face: twelve flexes with a left and a right value, which settle towards
// targets and are stirred by noise. Source: Perlin's face applet (1997, 2000), its controls, settle
// rule (95 % of the way in the settle time), noise amplitudes and frequencies. The applet adds its
// noise once a frame; here the same is an integral over time, so the tick rate does not matter:
//   dv/dt = rate (target - v) + 30 amplitude noise(3.6 frequency t),  rate = ln 20 / settle
// (30 frames a second, in which the applet's time advances by 3.6). Say_ah counts from shut lips
// (the applet's -1); blinks have a rhythm of their own (face.h), since the applet's is too quick
// for people.

enum class Flex : uint8_t {
  turn,
  nod,
  tilt,
  say_ah,
  blink,
  brows,
  look_x,
  look_y,
  lids,
  say_oo,
  smile,
  sneer
};
inline constexpr size_t flex_count = 12;
extern const std::array<const char*, flex_count>
    flex_names;  // the applet's names: "sayAh", "lookX", ...

struct PerlinFace {
  struct Value {
    float settled = 0, noise = 0, target = 0;
    float sum() const { return settled + noise; }
  };
  std::array<std::array<Value, 2>, flex_count> flex;  // [flex][left, right]
  Value& at(Flex which, size_t side) { return flex[size_t(which)][side]; }
};

inline constexpr float perlin_settle_seconds = 1;

// Sets both sides of a flex.
void set_target(PerlinFace& face, Flex flex, float target);
// Adds an emotion at `weight` to the targets of its flexes.
void add_targets(PerlinFace& face, Emotion emotion, float weight);
// Advances the face by `dt` seconds, to time `now`. Noise moves only the flexes that have any
// (brows, lids), times `stir`; 0 lets it die away. Returns the number of noise values that were
// drawn.
int tick_perlin(PerlinFace& face, float stir, float settle_seconds, double now, float dt);

// Holds a set as one figure can show it. It is made once for each figure; everything nested is
// flattened.
struct ExpressionRig {
  const ExpressionSet* set = nullptr;                  // borrowed
  std::vector<std::vector<ExpressionPart>> controls;   // controls, one list an expression
  std::vector<std::vector<ExpressionPart>> rotations;  // rotators, one list an expression
  struct Drive {
    int displacer = -1, rotator = -1;  // both -1: the figure lacks the control
    float scale = 1;
  };
  std::vector<Drive> drives;                 // one a control
  std::vector<int> joints;                   // one a rotator; -1: the figure lacks it
  std::array<int, emotion_count> emotion{};  // expressions by their names, -1: none
  std::array<int, 15> viseme{};              // in the order of Viseme
  int breathe = -1;
  // expressions by [left, right][minus, plus]
  std::array<std::array<std::array<int, 2>, 2>, flex_count> flex;
  std::vector<std::string> missing;  // expressions that the figure has nothing to show with
};
ExpressionRig make_expression_rig(const ExpressionSet& set, const Character& character);
// Returns whether the figure shows anything of an expression.
bool shows(const ExpressionRig& rig, int expression);

struct ExpressionSum {
  std::vector<float> controls, rotators;
};
// Makes the identity: nothing is asked for.
void clear(ExpressionSum& sum, const ExpressionRig& rig);
// Adds: sum += weight * expression. Unknown expressions (-1) and weights that are not finite add
// nothing.
void add(ExpressionSum& sum, const ExpressionRig& rig, int expression, float weight);
// Adds: sum += weight * other.
void add(ExpressionSum& sum, const ExpressionSum& other, float weight);
// Returns the weighted mean; weights that sum to nothing give the empty sum.
ExpressionSum mean(const ExpressionRig& rig, const std::vector<ExpressionSum>& sums,
                   const std::vector<float>& weights);

// Holds what must not be lost in a sum, after all layers are in.
struct Protected {
  std::array<float, 2> closing{0, 0};  // shares by which a blink closes the lids, 0..1
  std::array<float, 15> visemes{};     // weights of the speech's mouth shapes, 0..1
  float talking = 0;                   // 0..1: the mouth belongs to the words
};
// Adds speech and blink so that nothing else keeps lips or lids from closing: if a bilabial is at
// 1, no control that parts the lips is left, and if a blink is at 1, the lids are shut whatever the
// layers say.
void protect(ExpressionSum& sum, const ExpressionRig& rig, const Protected& what);

// Turns joints by the sum of their rotators' rotation vectors, over their pose. Called before the
// eyes are aimed, since heads turn.
void apply_rotators(const ExpressionSum& sum, const ExpressionRig& rig, Pose& pose);
// Clamps the controls to 0..1 and writes them into displacers (overwritten where the set controls
// them), or into the lids and jaws of figures that have joints instead.
void apply_controls(const ExpressionSum& sum, const ExpressionRig& rig, Pose& pose);

// ---- emotions, before they become a face ----

// Returns a + weight b, without bounds. Terms that are not finite add nothing.
Emotions add(const Emotions& a, const Emotions& b, float weight);
Emotions mix(const Emotions& a, const Emotions& b, float t);
// Returns what a face can show of a sum of layers: opposites cancel (joy and sadness, anger and
// fear), each is within 0..1, and all together weigh at most 1, so that no mixture becomes a
// grimace.
Emotions bounded(const Emotions& sum);

}  // namespace wellspring::avatar
