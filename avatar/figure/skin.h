// SPDX-License-Identifier: Apache-2.0
// Moves the vertices: displacers, then joints, blended as Character::skinning says; normals follow.
// It uses all cores, allocates nothing after the first call, and is called once a tick.
#pragma once
#include <vector>

#include "avatar/figure/character.h"
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// Blends dual quaternions (Kavan, Collins, Zara, O'Sullivan: Geometric Skinning with Approximate
// Dual Quaternion Blending, 2008, algorithm 1; section 4.2 for the order of scale and rigid part).
// A joint's matrix is taken apart into a turn and a way, which blend as a dual quaternion, and a
// stretch of the rest pose, which blends as a matrix.

struct DualQuaternion {
  quat real{1, 0, 0, 0}, dual{0, 0, 0, 0};
};

// Holds the parts of matrix = rigid(turn, way) * stretch; the stretch is symmetric and about the
// origin.
struct RigidPart {
  DualQuaternion rigid;
  mat3 stretch{1};
};
// Splits a matrix by polar decomposition (Higham 1986) if it does more than turn. Matrices that
// flatten space keep what is left of their turn.
RigidPart split_matrix(const mat4& matrix);

DualQuaternion make_dual_quaternion(quat turn, vec3 way);

// Returns the blended joints of a vertex: rows of the matrix that moves it. Joints in the other
// half of quaternion space than the heaviest one are taken with the other sign, so that the shorter
// way is taken. `stretches` is empty if no joint stretches.
glm::mat3x4 blend_dual_quaternions(const JointWeight* begin, const JointWeight* end,
                                   const std::vector<DualQuaternion>& joints,
                                   const std::vector<mat3>& stretches);

// Holds faces around the vertices that displacers move, so that a closing lid is shaded as it lies.
struct SkinFolds {
  const Character* character = nullptr;  // character for which the rest was made
  size_t vertex_count = 0;
  std::vector<uint32_t> vertices,
      group;                    // vertices whose normal may turn, and the group each belongs to
  uint32_t group_count = 0;     // number of groups: vertices at one place with one normal
  std::vector<uint32_t> first;  // triangles[first[g] .. first[g + 1]) lie around group g
  std::vector<uvec3> triangles;
  std::vector<vec3> rest_normal;  // mean of the faces at rest
  std::vector<quat> turn;         // turn from there to the present displacement
};

// This is the working memory of skin(), one per figure and thread, made by the first call.
struct SkinScratch {
  std::vector<mat4> joints;           // eval_joints() of the pose, after skin()
  std::vector<glm::mat3x4> rows;      // the same in the world, first three rows of each
  std::vector<DualQuaternion> rigid;  // dual quaternions: each joint's turn and way ...
  std::vector<mat3> stretches;        // ... and its stretch; empty: none
  std::vector<vec3> displaced, displaced_normals;
  SkinFolds folds;
};

// Moves the vertices. `placement` takes humanoid space to the world. Output vectors are resized to
// the character's vertices.
void skin(const Character& character, const Pose& pose, const mat4& placement, SkinScratch& scratch,
          std::vector<vec3>& positions, std::vector<vec3>& normals);

// Returns the unit area-weighted mean normal of the faces around a group; zero if they cancel.
vec3 eval_fold_normal(const SkinFolds& folds, uint32_t group, const std::vector<vec3>& positions);

}  // namespace wellspring::avatar
