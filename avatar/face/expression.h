// SPDX-License-Identifier: Apache-2.0
// The expression language. A rotation expression turns joints through rotators (a weight picks a
// place among orientations), a deform expression weights controls (displacers by role), a structure
// expression is made of expressions of all three kinds. They are data: JSON as docs/expressions.md
// has it. Source: the storyteller and kiosk paper, "VRML prototypes" (RotationExpression,
// DeformExpression, StructureExpression, Rotator). The algebra over them is in expression_sum.h.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

// The six archetypal expressions of MPEG-4 (ISO/IEC 14496-2, table of expression_select), by name
// and as a vector of weights. What a story, a situation and a visitor each ask for is such a
// vector.

enum class Emotion : uint8_t { joy, sadness, anger, fear, disgust, surprise };
inline constexpr size_t emotion_count = 6;
inline constexpr std::array<std::string_view, emotion_count> emotion_names = {
    "joy", "sadness", "anger", "fear", "disgust", "surprise"};

// Weights, 0..1 each where a face is to show them. All zero: neutral.
struct Emotions {
  std::array<float, emotion_count> weight{};
  float& operator[](Emotion emotion) { return weight[size_t(emotion)]; }
  float operator[](Emotion emotion) const { return weight[size_t(emotion)]; }
  bool operator==(const Emotions&) const = default;
};

// Index into emotion_names; -1: no such emotion.
constexpr int find_emotion(std::string_view name) {
  for (size_t i = 0; i < emotion_count; i++)
    if (emotion_names[i] == name) return int(i);
  return -1;
}

// To a joint what a displacer is to a mesh: orientations at growing weights, interpolated in
// between, the outermost ones beyond.
struct Rotator {
  std::string name, joint;  // H-Anim v2 name of the joint
  std::vector<float> weights;
  std::vector<dvec4> turns;        // one a weight: axis and angle in radians, as written
  std::vector<quat> orientations;  // the same, unit length
};

// What a control does to lips and lids, for the rules that protect them (expression_sum.h).
enum class ControlKind : uint8_t { plain, mouth, parts_lips, blink, opens_lids, viseme };

// A part of the face by its role, and what figures call it. Names are compared without regard to
// case.
struct Control {
  std::string name;
  ControlKind kind = ControlKind::plain;
  std::vector<std::string> displacers;  // the first that the figure has
  std::vector<std::string> shared;      // else the first of these, half of it: it moves both sides
  int rotator = -1;                     // else this one, if the figure has its joint
};

struct ExpressionPart {
  int index = 0;  // into rotators, controls or expressions, by the expression's kind
  float weight = 1;
};

struct NamedExpression {
  enum class Kind : uint8_t { rotation, deform, structure };
  std::string name, about;
  Kind kind = Kind::deform;
  std::vector<ExpressionPart> parts;
  int otherwise = -1;  // expression used by figures that have nothing of what this one needs
};

struct ExpressionSet {
  std::vector<Rotator> rotators;
  std::vector<Control> controls;
  std::vector<NamedExpression>
      expressions;  // parts and `otherwise` point at earlier ones: no cycles
};

inline constexpr size_t most_expressions = 4096;
inline constexpr float largest_expression_weight = 8;

// -1: no such thing.
int find_expression(const ExpressionSet& set, std::string_view name);
int find_control(const ExpressionSet& set, std::string_view name);

// Orientation at a weight: shortest way between neighbours. NaN counts as 0.
quat eval_rotator(const Rotator& rotator, float weight);

// The set that comes with the program.
const ExpressionSet& default_expressions();

// Throws LoadError with the place of the first thing wrong; `file` names it in messages. An
// expression may be used only after its own entry.
ExpressionSet read_expressions(std::string_view json, const std::string& file);
ExpressionSet load_expressions(const std::string& file);

}  // namespace wellspring::avatar
