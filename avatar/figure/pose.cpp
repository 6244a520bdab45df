// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/pose.h"

namespace wellspring::avatar {

Pose make_rest_pose(const Character& character) {
  Pose pose;
  pose.rotations.assign(character.joints.size(), quat(1, 0, 0, 0));
  pose.displacers.assign(character.displacers.size(), 0);
  return pose;
}

void eval_joints(const Character& character, const Pose& pose, std::vector<mat4>& to_humanoid) {
  to_humanoid.resize(character.joints.size());
  for (size_t j = 0; j < character.joints.size(); j++) {
    const Joint& joint = character.joints[j];
    quat turn = j < pose.rotations.size() ? pose.rotations[j] : quat(1, 0, 0, 0);
    float length = glm::length(turn);
    turn = length > 1e-6f && length < 1e6f ? turn * (1 / length) : quat(1, 0, 0, 0);
    mat4 local = glm::mat4_cast(turn);
    if (j < pose.stretches.size()) local = local * mat4(pose.stretches[j]);
    vec3 place = joint.center;
    if (j < pose.translations.size() && is_finite(pose.translations[j]))
      place += pose.translations[j];
    local[3] = vec4(place - mat3(local) * joint.center, 1);  // turns about the centre
    if (joint.parent >= 0) to_humanoid[j] = to_humanoid[size_t(joint.parent)] * local;
    else
      to_humanoid[j] =
          is_finite(pose.translation) ? glm::translate(mat4(1), pose.translation) * local : local;
  }
}

JointFrame eval_joint_frame(const Character& character, const Pose& pose, int joint) {
  // From the joint up to the root: p' = c + r (p - c).
  quat rotation(1, 0, 0, 0);
  vec3 place = character.joints[size_t(joint)].center;
  for (int j = joint; j >= 0; j = character.joints[size_t(j)].parent) {
    quat turn = pose.rotations[size_t(j)];
    vec3 center = character.joints[size_t(j)].center;
    place = center + turn * (place - center);
    if (size_t(j) < pose.translations.size()) place += pose.translations[size_t(j)];
    rotation = turn * rotation;
    if (character.joints[size_t(j)].parent < 0) place += pose.translation;
  }
  return {rotation, place};
}

}  // namespace wellspring::avatar
