// SPDX-License-Identifier: Apache-2.0
// A figure at one instant: joint rotations and displacer weights. Made afresh each tick.
#pragma once
#include <vector>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

struct Pose {
  vec3 translation{0};            // of the root, humanoid space
  std::vector<quat> rotations;    // one a joint, relative to its parent; identity is the rest pose
  std::vector<float> displacers;  // one a displacer, 0..1 nominal
  // What motions of the figure's own file may ask for besides; empty, or one a joint. A way is
  // about the axes of the parent's frame, a stretch is symmetric and comes before the turn.
  std::vector<vec3> translations;
  std::vector<mat3> stretches;
};

Pose make_rest_pose(const Character& character);

// Where each joint's frame is: `to_humanoid[j]` maps a rest-pose point moved by joint j into
// humanoid space.
void eval_joints(const Character& character, const Pose& pose, std::vector<mat4>& to_humanoid);

// A joint's frame as posed: rotation and place of its centre, humanoid space.
struct JointFrame {
  quat rotation{1, 0, 0, 0};
  vec3 center{0};
};
JointFrame eval_joint_frame(const Character& character, const Pose& pose, int joint);

}  // namespace wellspring::avatar
