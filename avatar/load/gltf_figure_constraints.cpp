// SPDX-License-Identifier: Apache-2.0
// Constraints between a file's nodes as constraints between the figure's joints: axes in humanoid
// space, in an order in which they can be followed.
#include "avatar/load/gltf_figure.h"
#include "avatar/load/gltf_frames.h"
#include "avatar/figure/joint_constraints.h"

namespace wellspring::avatar {

void read_gltf_constraints(GltfFigure& figure) {
  Character& character = figure.character;
  glm::dquat to_humanoid = gltf_rotation(figure.to_humanoid);
  auto turn_of = [&](size_t node) { return to_humanoid * gltf_rotation(figure.rest[node]); };
  auto turn_above = [&](size_t node) {
    int parent = figure.nodes[node].parent;
    return parent < 0 ? to_humanoid : turn_of(size_t(parent));
  };
  for (const VrmConstraint& asked : figure.vrm.constraints) {
    JointConstraint constraint;
    constraint.joint = figure.joint_of[asked.node];
    constraint.source = figure.joint_of[asked.source];
    if (constraint.joint < 0 || constraint.source < 0) continue;
    constraint.kind = asked.kind;
    constraint.weight = asked.weight;
    constraint.axis = quat(turn_of(asked.node)) * asked.axis;
    // A rotation is carried from the source's own axes to the joint's own, a roll from the axes of
    // what is above the one to those above the other.
    if (asked.kind == JointConstraint::Kind::rotation)
      constraint.between =
          quat(glm::normalize(turn_of(asked.node) * glm::conjugate(turn_of(asked.source))));
    else if (asked.kind == JointConstraint::Kind::roll)
      constraint.between =
          quat(glm::normalize(turn_above(asked.node) * glm::conjugate(turn_above(asked.source))));
    character.constraints.push_back(constraint);
  }
  std::vector<JointConstraint> circular = sort_constraints(character.joints, character.constraints);
  if (circular.empty()) return;
  std::string names;
  for (size_t k = 0; k < circular.size() && k < 8; k++)
    names += (k ? ", " : "") + character.joints[size_t(circular[k].joint)].name.substr(0, 40);
  gltf::warn(
      figure.file, "/nodes",
      "constraints that depend on themselves or on one another in a circle are not followed: " +
          names + (circular.size() > 8 ? ", ..." : ""));
}

}  // namespace wellspring::avatar
