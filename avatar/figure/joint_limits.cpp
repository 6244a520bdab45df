// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/joint_limits.h"

#include <algorithm>
#include <cmath>

namespace wellspring::avatar {

namespace {

vec3 rotation_vector(quat q) {
  if (q.w < 0) q = -q;
  vec3 axis(q.x, q.y, q.z);
  float sine = glm::length(axis);
  if (sine < 1e-9f) return 2.0f * axis;
  return axis * (2 * std::atan2(sine, q.w) / sine);
}

quat turn_of(vec3 vector) {
  float angle = glm::length(vector);
  return angle > 1e-9f ? glm::angleAxis(angle, vector / angle) : quat(1, 0, 0, 0);
}

}  // namespace

bool has_limits(const Joint& joint) {
  return std::any_of(joint.limits.begin(), joint.limits.end(),
                     [](vec2 range) { return range.x < range.y; });
}

quat limit_turn(const Joint& joint, quat turn) {
  if (!has_limits(joint)) return turn;
  const quat& frame = joint.limit_orientation;
  vec3 wanted = rotation_vector(glm::conjugate(frame) * turn * frame), kept = wanted;
  for (size_t axis = 0; axis < 3 && axis < joint.limits.size(); axis++) {
    vec2 range = joint.limits[axis];
    if (!(range.x <= range.y)) continue;
    kept[int(axis)] =
        std::clamp(wanted[int(axis)], std::min(range.x, 0.0f), std::max(range.y, 0.0f));
  }
  if (kept == wanted) return turn;
  return frame * turn_of(kept) * glm::conjugate(frame);
}

float readiness(const Joint& joint) {
  vec3 stiffness = clamp(joint.stiffness, vec3(0), vec3(1));
  return 1 - (stiffness.x + stiffness.y + stiffness.z) / 3;
}

}  // namespace wellspring::avatar
