// SPDX-License-Identifier: Apache-2.0
// Springs of a VRM file as springs of the figure: by joint, in humanoid space, metres.
#include <algorithm>
#include <cmath>

#include "avatar/load/gltf_figure.h"

namespace wellspring::avatar {

void read_gltf_springs(GltfFigure& figure) {
  Character& character = figure.character;
  auto place = [&](size_t node, vec3 offset) {
    return vec3(figure.to_humanoid * figure.rest[node] * dvec4(dvec3(offset), 1));
  };
  auto size_at = [&](size_t node) {
    return float(
        std::cbrt(std::abs(glm::determinant(glm::dmat3(figure.to_humanoid * figure.rest[node])))));
  };
  std::vector<int> collider_of;  // the figure's, of each of the file's
  for (const VrmCollider& collider : figure.vrm.colliders) {
    SpringCollider made;
    made.joint = figure.nearest_joint[collider.node];
    made.place = place(collider.node, collider.offset);
    made.tail = place(collider.node, collider.tail);
    made.radius = collider.radius * size_at(collider.node);
    made.inside = collider.inside;
    if (collider.normal != vec3(0)) {
      vec3 normal = place(collider.node, collider.offset + collider.normal) - made.place;
      float length = glm::length(normal);
      made.normal = length > 0 ? normal / length : vec3(0, 1, 0);
    }
    bool sound = made.joint >= 0 && is_finite(made.place) && is_finite(made.tail) &&
                 is_finite(made.normal) && std::isfinite(made.radius);
    collider_of.push_back(sound ? int(character.spring_colliders.size()) : -1);
    if (sound) character.spring_colliders.push_back(made);
  }
  // Directions of gravity are those of the file's world; its strength does not scale.
  glm::dmat3 turn(figure.to_humanoid);
  turn /= std::cbrt(std::abs(glm::determinant(turn)));
  for (const VrmSpringJoint& joint : figure.vrm.springs) {
    SpringBone bone;
    bone.joint = figure.joint_of[joint.node];
    if (bone.joint < 0) continue;  // nothing hangs on it
    vec3 own = character.joints[size_t(bone.joint)].center;
    bone.tail = (joint.tail_node >= 0 ? place(size_t(joint.tail_node), vec3(0))
                                      : place(joint.node, joint.tail)) -
                own;
    float length = glm::length(bone.tail);
    if (!(length > 1e-5f) || !std::isfinite(length)) continue;
    bone.stiffness = joint.stiffness;
    float direction = glm::length(joint.gravity_direction);
    if (direction > 1e-6f)
      bone.gravity = vec3(turn * dvec3(joint.gravity_direction / direction)) * joint.gravity_power;
    bone.drag = joint.drag;
    bone.radius = joint.hit_radius * size_at(joint.node);
    if (joint.center >= 0) bone.center = figure.nearest_joint[size_t(joint.center)];
    if (bone.center >= bone.joint) bone.center = -1;  // not above it: it would turn with itself
    for (size_t c : joint.colliders)
      if (collider_of[c] >= 0) bone.colliders.push_back(collider_of[c]);
    character.springs.push_back(std::move(bone));
  }
  std::sort(character.springs.begin(), character.springs.end(),
            [](const SpringBone& a, const SpringBone& b) { return a.joint < b.joint; });
}

}  // namespace wellspring::avatar
