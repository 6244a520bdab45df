// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/joint_constraints.h"

#include <algorithm>
#include <cmath>

namespace wellspring::avatar {
namespace {

using Kind = JointConstraint::Kind;
constexpr quat no_turn(1, 0, 0, 0);

// Returns the smallest turn from one unit vector to another.
quat turn_from_to(vec3 from, vec3 to) {
  float w = 1 + dot(from, to);
  vec3 axis = cross(from, to);
  if (w < 1e-6f) {  // opposite: any axis across will do, the same each time
    axis = cross(from, std::abs(from.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0));
    w = 0;
  }
  return glm::normalize(quat(w, axis.x, axis.y, axis.z));
}

bool is_turn(quat q) {
  float square = glm::dot(q, q);
  return square > 1e-12f && square < 1e12f;  // false for NaN
}

// Calls `body` with each joint whose turn a constraint reads, once.
template <class Body>
void each_dependency(const std::vector<Joint>& joints, const JointConstraint& constraint,
                     Body&& body) {
  if (constraint.kind != Kind::aim || constraint.source == constraint.joint)
    return body(constraint.source);
  for (int of : {constraint.source, constraint.joint})  // places depend on the joints above
    for (int j = joints[size_t(of)].parent; j >= 0; j = joints[size_t(j)].parent) body(j);
}

}  // namespace

quat eval_constraint(const Character& character, const JointConstraint& constraint,
                     const Pose& pose) {
  quat target = no_turn;
  if (constraint.kind == Kind::aim) {
    int parent = character.joints[size_t(constraint.joint)].parent;
    JointFrame own = eval_joint_frame(character, pose, constraint.joint);
    quat above = parent < 0 ? no_turn : eval_joint_frame(character, pose, parent).rotation;
    vec3 way = eval_joint_frame(character, pose, constraint.source).center - own.center;
    way = glm::conjugate(above) * way;
    float length = glm::length(way);
    if (!(length > 1e-6f) || !std::isfinite(length)) return no_turn;
    target = turn_from_to(constraint.axis, way / length);
  } else {
    quat source = pose.rotations[size_t(constraint.source)];
    if (!is_turn(source)) return no_turn;
    const quat& between = constraint.between;
    target = between * glm::normalize(source) * glm::conjugate(between);
    // A roll is what is left of the turn when the axis has been brought to where the turn takes it.
    if (constraint.kind == Kind::roll)
      target =
          glm::conjugate(turn_from_to(constraint.axis, glm::normalize(target * constraint.axis))) *
          target;
  }
  if (!is_turn(target)) return no_turn;
  target = glm::normalize(target);
  if (target.w < 0) target = -target;  // the shorter way
  return glm::normalize(glm::slerp(no_turn, target, constraint.weight));
}

void follow_constraints(const Character& character, Pose& pose) {
  if (pose.rotations.size() != character.joints.size()) return;
  for (const JointConstraint& constraint : character.constraints)
    pose.rotations[size_t(constraint.joint)] = eval_constraint(character, constraint, pose);
}

std::vector<JointConstraint> sort_constraints(const std::vector<Joint>& joints,
                                              std::vector<JointConstraint>& constraints) {
  // Each round takes what waits for nothing (Kahn 1962); each joint is turned by one constraint at
  // most.
  size_t count = constraints.size();
  std::vector<int> turned_by(joints.size(), -1);
  for (size_t k = 0; k < count; k++) turned_by[size_t(constraints[k].joint)] = int(k);
  std::vector<std::vector<size_t>> waiting(count);  // for each constraint those that wait for it
  std::vector<size_t> waits(count, 0);
  for (size_t k = 0; k < count; k++)
    each_dependency(joints, constraints[k], [&](int joint) {
      int other = turned_by[size_t(joint)];
      if (other < 0) return;
      waiting[size_t(other)].push_back(k);
      waits[k]++;
    });
  std::vector<size_t> order;
  for (size_t k = 0; k < count; k++)
    if (waits[k] == 0) order.push_back(k);
  for (size_t next = 0; next < order.size(); next++)
    for (size_t k : waiting[order[next]])
      if (--waits[k] == 0) order.push_back(k);
  std::vector<JointConstraint> sorted, circular;
  for (size_t k : order) sorted.push_back(constraints[k]);
  for (size_t k = 0; k < count; k++)
    if (waits[k] > 0) circular.push_back(constraints[k]);
  constraints = std::move(sorted);
  return circular;
}

}  // namespace wellspring::avatar
