// SPDX-License-Identifier: Apache-2.0
// Dual quaternion blending (Kavan, Collins, Zara, O'Sullivan: Geometric Skinning with Approximate
// Dual Quaternion Blending, 2008, algorithm 1; section 4.2 for the order of scale and rigid part).
// A joint's matrix is taken apart into a turn and a way, which blend as a dual quaternion, and a
// stretch of the rest pose, which blends as a matrix.
#pragma once
#include <vector>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

struct DualQuaternion {
  quat real{1, 0, 0, 0}, dual{0, 0, 0, 0};
};

// matrix = rigid(turn, way) * stretch; the stretch is symmetric and about the origin.
struct RigidPart {
  DualQuaternion rigid;
  mat3 stretch{1};
};
// Polar decomposition (Higham 1986) where the matrix does more than turn. Matrices that flatten
// space keep what is left of their turn.
RigidPart split_matrix(const mat4& matrix);

DualQuaternion make_dual_quaternion(quat turn, vec3 way);

// The joints of a vertex blended: rows of the matrix that moves it. Joints in the other half of
// quaternion space than the heaviest one are taken with the other sign, so that the shorter way is
// gone. `stretches`: empty where no joint stretches.
glm::mat3x4 blend_dual_quaternions(const JointWeight* begin, const JointWeight* end,
                                   const std::vector<DualQuaternion>& joints,
                                   const std::vector<mat3>& stretches);

}  // namespace wellspring::avatar
