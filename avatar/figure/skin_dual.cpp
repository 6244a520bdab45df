// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/skin_dual.h"

#include <cmath>

namespace wellspring::avatar {
namespace {

bool is_turn(const mat3& m) {
  mat3 off = glm::transpose(m) * m - mat3(1);
  float most = 0;
  for (int c = 0; c < 3; c++)
    for (int r = 0; r < 3; r++) most = std::max(most, std::abs(off[c][r]));
  return most < 1e-5f && glm::determinant(m) > 0;
}

// The turn of the polar decomposition by Newton's iteration.
glm::dmat3 nearest_turn(glm::dmat3 m) {
  for (int i = 0; i < 40; i++) {
    double volume = glm::determinant(m);
    if (!(std::abs(volume) > 1e-18)) break;
    glm::dmat3 next = 0.5 * (m + glm::transpose(glm::inverse(m)));
    double change = 0;
    for (int c = 0; c < 3; c++) change += glm::length(next[c] - m[c]);
    m = next;
    if (change < 1e-12) break;
  }
  if (glm::determinant(m) < 0) m = -m;  // a mirror is part of the stretch
  // What is left of a flattened space: two axes, squared up.
  dvec3 x = m[0], y = m[1];
  double lx = glm::length(x);
  x = lx > 1e-9 ? x / lx : dvec3(1, 0, 0);
  y -= x * glm::dot(x, y);
  double ly = glm::length(y);
  if (ly > 1e-9) y /= ly;
  else y = glm::normalize(glm::cross(std::abs(x.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(0, 0, 1), x));
  return glm::dmat3(x, y, glm::cross(x, y));
}

}  // namespace

DualQuaternion make_dual_quaternion(quat turn, vec3 way) {
  return {turn, quat(0, way.x, way.y, way.z) * turn * 0.5f};
}

RigidPart split_matrix(const mat4& matrix) {
  mat3 linear(matrix);
  RigidPart part;
  if (is_turn(linear)) {
    part.rigid = make_dual_quaternion(glm::normalize(glm::quat_cast(linear)), vec3(matrix[3]));
    return part;
  }
  glm::dmat3 turn = nearest_turn(glm::dmat3(linear));
  part.stretch = mat3(glm::transpose(turn) * glm::dmat3(linear));
  part.rigid = make_dual_quaternion(quat(glm::normalize(glm::quat_cast(turn))), vec3(matrix[3]));
  return part;
}

glm::mat3x4 blend_dual_quaternions(const JointWeight* begin, const JointWeight* end,
                                   const std::vector<DualQuaternion>& joints,
                                   const std::vector<mat3>& stretches) {
  const JointWeight* pivot = begin;
  for (const JointWeight* w = begin; w != end; w++)
    if (w->weight > pivot->weight) pivot = w;
  const quat& side = joints[pivot->joint].real;
  quat real(0, 0, 0, 0), dual(0, 0, 0, 0);
  for (const JointWeight* w = begin; w != end; w++) {
    const DualQuaternion& q = joints[w->joint];
    float weight = dot(q.real, side) < 0 ? -w->weight : w->weight;
    real += q.real * weight;
    dual += q.dual * weight;
  }
  // At least the pivot's own weight is left of the length: no other stands against it.
  float inverse = 1 / std::sqrt(dot(real, real));
  real *= inverse;
  dual *= inverse;
  float x = real.x, y = real.y, z = real.z, w = real.w;
  vec3 v(x, y, z), u(dual.x, dual.y, dual.z);
  vec3 way = 2.0f * (w * u - dual.w * v + cross(v, u));
  vec3 rows[3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                  {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                  {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  if (!stretches.empty()) {
    mat3 stretch(0);
    for (const JointWeight* j = begin; j != end; j++) stretch += stretches[j->joint] * j->weight;
    for (vec3& row : rows) row = row * stretch;
  }
  return glm::mat3x4(vec4(rows[0], way.x), vec4(rows[1], way.y), vec4(rows[2], way.z));
}

}  // namespace wellspring::avatar
