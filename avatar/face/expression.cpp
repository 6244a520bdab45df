// SPDX-License-Identifier: Apache-2.0
#include "avatar/face/expression.h"

#include <algorithm>
#include <cmath>

#include "avatar/face/library_json.h"

namespace wellspring::avatar {

int find_expression(const ExpressionSet& set, std::string_view name) {
  for (size_t i = 0; i < set.expressions.size(); i++)
    if (set.expressions[i].name == name) return int(i);
  return -1;
}

int find_control(const ExpressionSet& set, std::string_view name) {
  for (size_t i = 0; i < set.controls.size(); i++)
    if (set.controls[i].name == name) return int(i);
  return -1;
}

quat eval_rotator(const Rotator& rotator, float weight) {
  if (rotator.weights.empty()) return quat(1, 0, 0, 0);
  if (!std::isfinite(weight)) weight = 0;
  size_t last = rotator.weights.size() - 1;
  if (weight <= rotator.weights[0]) return rotator.orientations[0];
  if (weight >= rotator.weights[last]) return rotator.orientations[last];
  size_t i = 0;
  while (weight > rotator.weights[i + 1]) i++;
  float t = (weight - rotator.weights[i]) / (rotator.weights[i + 1] - rotator.weights[i]);
  return glm::normalize(glm::slerp(rotator.orientations[i], rotator.orientations[i + 1], t));
}

const ExpressionSet& default_expressions() {
  static const ExpressionSet set = read_expressions(default_expressions_json(), "expressions.json");
  return set;
}

}  // namespace wellspring::avatar
