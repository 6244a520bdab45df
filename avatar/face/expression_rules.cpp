// SPDX-License-Identifier: Apache-2.0
#include "avatar/face/expression_rules.h"

#include <algorithm>
#include <cmath>

namespace wellspring::avatar {
namespace {

float clamp_weight(float v) { return v > 0 ? std::min(v, 1.0f) : 0; }  // NaN: 0

// Returns how much is left of a group: nothing if an expression blocks it or several together fade
// it out.
float left_of(const Character& character, size_t group, const Pose& pose) {
  float taken = 0;
  for (const ExpressionRule& rule : character.expression_rules) {
    float weight = clamp_weight(pose.displacers[size_t(rule.displacer)]);
    if (weight == 0 || rule.group == int(group)) continue;  // a blink does not forbid blinking
    if (rule.overrides[group] == ExpressionOverride::block) return 0;
    if (rule.overrides[group] == ExpressionOverride::blend) taken += weight;
  }
  return 1 - std::min(taken, 1.0f);
}

}  // namespace

void follow_expression_rules(const Character& character, Pose& pose) {
  const auto& rules = character.expression_rules;
  if (rules.empty() || pose.displacers.size() != character.displacers.size()) return;
  for (const ExpressionRule& rule : rules) {
    float& weight = pose.displacers[size_t(rule.displacer)];
    if (rule.binary) weight = weight > 0.5f ? 1.0f : 0.0f;
  }
  std::array<float, expression_groups> left;
  for (size_t group = 0; group < expression_groups; group++)
    left[group] = left_of(character, group, pose);
  for (const ExpressionRule& rule : rules) {
    if (rule.group < 0) continue;
    float share = left[size_t(rule.group)];
    pose.displacers[size_t(rule.displacer)] *= rule.binary && share < 1 ? 0 : share;
  }
  float gaze = left[size_t(ExpressionGroup::gaze)];
  if (gaze == 1) return;
  for (const char* name : {"l_eyeball_joint", "r_eyeball_joint"})
    if (int eye = find_joint(character, name); eye >= 0 && size_t(eye) < pose.rotations.size())
      pose.rotations[size_t(eye)] = glm::slerp(quat(1, 0, 0, 0), pose.rotations[size_t(eye)], gaze);
}

void eval_appearance_changes(const Character& character, const Pose& pose,
                             std::vector<AppearanceChange>& changes) {
  changes.assign(character.appearances.size(), {});
  for (const AppearanceChange& change : character.appearance_changes) {
    if (size_t(change.displacer) >= pose.displacers.size() ||
        size_t(change.appearance) >= changes.size())
      continue;
    float weight = clamp_weight(pose.displacers[size_t(change.displacer)]);
    if (weight == 0) continue;
    AppearanceChange& sum = changes[size_t(change.appearance)];
    sum.base_color += weight * change.base_color;
    sum.emission += weight * change.emission;
    sum.uv += weight * change.uv;
  }
}

}  // namespace wellspring::avatar
