// SPDX-License-Identifier: Apache-2.0
// Holds the expression language. A rotation expression turns joints through rotators (a weight
// picks a place among orientations), a deform expression weights controls (displacers by role), a
// structure expression is made of expressions of all three kinds. They are data: JSON as
// docs/expressions.md has it. Source: the storyteller and kiosk paper, "VRML prototypes"
// (RotationExpression, DeformExpression, StructureExpression, Rotator). The algebra over them is in
// expression_sum.h.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

// Holds the six archetypal expressions of MPEG-4 (ISO/IEC 14496-2, table of expression_select), by
// name and as a vector of weights. A story, a situation and a visitor each ask for such a vector.

enum class Emotion : uint8_t { joy, sadness, anger, fear, disgust, surprise };
inline constexpr size_t emotion_count = 6;
inline constexpr std::array<std::string_view, emotion_count> emotion_names = {
    "joy", "sadness", "anger", "fear", "disgust", "surprise"};

// Holds weights, each 0..1 when a face is to show them. All zero: neutral.
struct Emotions {
  std::array<float, emotion_count> weight{};
  float& operator[](Emotion emotion) { return weight[size_t(emotion)]; }
  float operator[](Emotion emotion) const { return weight[size_t(emotion)]; }
  bool operator==(const Emotions&) const = default;
};

// Returns the index into emotion_names; -1: no such emotion.
constexpr int find_emotion(std::string_view name) {
  for (size_t i = 0; i < emotion_count; i++)
    if (emotion_names[i] == name) return int(i);
  return -1;
}

// This is to a joint what a displacer is to a mesh: orientations at growing weights, interpolated
// in between, the outermost ones beyond.
struct Rotator {
  std::string name, joint;  // H-Anim v2 name of the joint
  std::vector<float> weights;
  std::vector<dvec4> turns;        // one a weight: axis and angle in radians, as written
  std::vector<quat> orientations;  // the same as unit quaternions
};

// Names what a control does to lips and lids, for the rules that protect them (expression_sum.h).
enum class ControlKind : uint8_t { plain, mouth, parts_lips, blink, opens_lids, viseme };

// Names a part of the face by its role, with the names that figures give it. Names are compared
// without regard to case.
struct Control {
  std::string name;
  ControlKind kind = ControlKind::plain;
  std::vector<std::string> displacers;  // the first one that the figure has counts
  std::vector<std::string> shared;      // else the first of these, by half: it moves both sides
  int rotator = -1;                     // else this rotator, if the figure has its joint
};

struct ExpressionPart {
  int index = 0;  // index into rotators, controls or expressions, by the expression's kind
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

// Return an index; -1: no such name.
int find_expression(const ExpressionSet& set, std::string_view name);
int find_control(const ExpressionSet& set, std::string_view name);

// Returns the orientation at a weight, by the shortest way between neighbours. NaN counts as 0.
quat eval_rotator(const Rotator& rotator, float weight);

// Returns the set that comes with the program.
const ExpressionSet& default_expressions();

// Reads a set. Throws LoadError with the place of the first error; `file` names it in messages. An
// expression may be used only after its own entry.
ExpressionSet read_expressions(std::string_view json, const std::string& file);
ExpressionSet load_expressions(const std::string& file);

}  // namespace wellspring::avatar
