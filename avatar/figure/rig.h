// SPDX-License-Identifier: Apache-2.0
// Describes a character for those who move it: which joints are its spine, neck, arms, legs and
// eyes, and how its arms must turn to hang straight down, so that one gesture fits figures drawn in
// I-, A- or T-pose. Parts that a figure lacks are -1 and stay still. It is made once per character.
#pragma once
#include <array>
#include <vector>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

// Holds a figure at one instant: joint rotations and displacer weights. It is made afresh each
// tick.

struct Pose {
  vec3 translation{0};            // shift of the root, humanoid space
  std::vector<quat> rotations;    // one a joint, relative to its parent; identity is the rest pose
  std::vector<float> displacers;  // one a displacer, 0..1 nominal
  // Shifts and stretches that motions of the figure's own file may have, too; empty, or one a
  // joint. A translation is along the axes of the parent's frame; a stretch is symmetric and comes
  // before the turn.
  std::vector<vec3> translations;
  std::vector<mat3> stretches;
};

Pose make_rest_pose(const Character& character);

// Finds each joint's frame: `to_humanoid[j]` maps a rest-pose point moved by joint j into humanoid
// space.
void eval_joints(const Character& character, const Pose& pose, std::vector<mat4>& to_humanoid);

// Holds a joint's frame as posed: rotation and place of its centre, humanoid space.
struct JointFrame {
  quat rotation{1, 0, 0, 0};
  vec3 center{0};
};
JointFrame eval_joint_frame(const Character& character, const Pose& pose, int joint);

struct WeightedJoint {
  int joint = -1;
  float share = 1;  // share of the whole chain's turn; shares sum to 1
};

struct FingerJoint {
  int joint = -1;
  int finger = 0;   // 0 thumb .. 4 little
  int knuckle = 0;  // 0 at the palm, 1, 2
  float bent = 0;   // flexion at rest, radians
  vec3 axis{0};     // axis that bends the joint, humanoid space at rest
};

struct ArmRig {
  int collar = -1, shoulder = -1, elbow = -1, wrist = -1;
  // Rotations of the rest pose (humanoid space) that make upper arm, forearm and hand hang straight
  // down, palm in.
  quat upper_hangs{1, 0, 0, 0}, fore_hangs{1, 0, 0, 0}, hand_hangs{1, 0, 0, 0};
  float spread = 0;  // angle by which the upper arm stands off at rest, radians
  std::vector<FingerJoint> fingers;
  vec3 curl_axis{0};  // axis that closes the fingers but the thumb, humanoid space at rest
};

struct LegRig {
  int hip = -1, knee = -1, ankle = -1;
  vec3 pole{0, 0, 1};  // direction of the knee at rest
  bool complete() const { return hip >= 0 && knee >= 0 && ankle >= 0; }
};

struct Rig {
  const Character* character = nullptr;
  size_t joints = 0, displacers = 0;
  int root = 0;
  std::vector<WeightedJoint> spine, neck;  // joints from below
  int skull = -1, jaw = -1;
  std::array<int, 2> eye{-1, -1}, lid{-1, -1};                   // left, right; joints
  bool jaw_moves = false, lids_move = false, eyes_move = false;  // the joint has vertices
  std::array<ArmRig, 2> arm;
  std::array<LegRig, 2> leg;
  vec3 eyes_center{0};  // middle between the eyes at rest, humanoid space

  // These are displacers, found by name.
  std::array<int, 2> blink{-1, -1}, smile{-1, -1}, brow_up{-1, -1};
  int brow_inner_up = -1, mouth_open = -1, breathe = -1;
  std::array<int, 2> squint{-1, -1}, lid_wide{-1, -1};  // "squint_l" or, for both, "squint"
  std::array<int, 15> viseme{};  // in the order sil PP FF TH DD kk CH SS nn RR aa E ih oh ou
  std::array<int, 4> look{-1, -1, -1,
                          -1};  // displacers of eyes without joints: up, down, left, right
};

Rig make_rig(const Character& character);

}  // namespace wellspring::avatar
