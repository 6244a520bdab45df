// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/skin.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "base/parallel.h"

namespace wellspring::avatar {
namespace {

bool is_turn(const mat3& m) {
  mat3 off = glm::transpose(m) * m - mat3(1);
  float most = 0;
  for (int c = 0; c < 3; c++)
    for (int r = 0; r < 3; r++) most = std::max(most, std::abs(off[c][r]));
  return most < 1e-5f && glm::determinant(m) > 0;
}

// Returns the turn of the polar decomposition by Newton's iteration.
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
  // A flattened space has two axes left, which are squared up.
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

namespace {

vec3 unit_or(vec3 v, vec3 otherwise) {
  float squared = dot(v, v);
  return squared > 1e-30f && squared < 1e30f ? v / std::sqrt(squared) : otherwise;
}

// Finds triangles around the vertices that displacers move, so that their normals can follow.
// Vertices that were split for a texture seam share one sum.
void make_folds(const Character& character, SkinFolds& folds) {
  folds = {};
  folds.character = &character;
  folds.vertex_count = character.positions.size();
  std::vector<uint8_t> moves(character.positions.size(), 0);
  for (const Displacer& displacer : character.displacers)
    for (uint32_t v : displacer.vertices) moves[v] = 1;
  // Vertices of a triangle with a moved corner get a new normal too.
  std::vector<uint8_t> turns(moves.size(), 0);
  for (const Part& part : character.parts)
    for (uvec3 t : part.triangles)
      if (moves[t.x] | moves[t.y] | moves[t.z]) turns[t.x] = turns[t.y] = turns[t.z] = 1;

  struct Key {
    vec3 position, normal;
    bool operator==(const Key& other) const { return std::memcmp(this, &other, sizeof *this) == 0; }
  };
  struct Hash {
    size_t operator()(const Key& key) const {
      uint32_t words[6];
      std::memcpy(words, &key, sizeof words);
      uint64_t h = 14695981039346656037ull;
      for (uint32_t w : words) h = (h ^ w) * 1099511628211ull;
      return size_t(h ^ (h >> 31));
    }
  };
  std::unordered_map<Key, uint32_t, Hash> groups;
  constexpr uint32_t none = 0xffffffffu;
  std::vector<uint32_t> group_of(moves.size(), none);
  for (size_t v = 0; v < moves.size(); v++) {
    if (!turns[v]) continue;
    vec3 n = glm::round(character.normals[v] * 1024.0f) + vec3(0);  // + 0: no negative zeros
    auto [place, added] =
        groups.emplace(Key{character.positions[v] + vec3(0), n}, uint32_t(groups.size()));
    group_of[v] = place->second;
    folds.vertices.push_back(uint32_t(v));
    folds.group.push_back(place->second);
  }
  folds.group_count = uint32_t(groups.size());
  std::vector<uint32_t> count(folds.group_count + 1, 0);
  auto each_corner = [&](auto&& body) {
    for (const Part& part : character.parts)
      for (uvec3 t : part.triangles)
        for (uint32_t v : {t.x, t.y, t.z})
          if (group_of[v] != none) body(group_of[v], t);
  };
  each_corner([&](uint32_t g, uvec3) { count[g + 1]++; });
  for (size_t g = 0; g < folds.group_count; g++) count[g + 1] += count[g];
  folds.first = count;
  folds.triangles.resize(count.back());
  each_corner([&](uint32_t g, uvec3 t) { folds.triangles[count[g]++] = t; });
  folds.rest_normal.resize(folds.group_count);
  folds.turn.resize(folds.group_count);
  for (uint32_t g = 0; g < folds.group_count; g++)
    folds.rest_normal[g] = eval_fold_normal(folds, g, character.positions);
}

bool is_rigid(const mat4& m) {
  mat3 off = glm::transpose(mat3(m)) * mat3(m) - mat3(1);
  float most = 0;
  for (int c = 0; c < 3; c++)
    for (int r = 0; r < 3; r++) most = std::max(most, std::abs(off[c][r]));
  return most < 1e-5f && glm::determinant(mat3(m)) > 0;
}

// Turns joints into dual quaternions. A rigid placement goes into them; otherwise `after` holds
// what is left to be done to the blended vertex.
void split_joints(const mat4& placement, SkinScratch& scratch, mat4& after) {
  bool rigid = is_rigid(placement);
  after = rigid ? mat4(1) : placement;
  scratch.rigid.resize(scratch.joints.size());
  scratch.stretches.clear();
  for (size_t j = 0; j < scratch.joints.size(); j++) {
    RigidPart part = split_matrix(rigid ? placement * scratch.joints[j] : scratch.joints[j]);
    scratch.rigid[j] = part.rigid;
    if (part.stretch == mat3(1)) continue;
    if (scratch.stretches.empty()) scratch.stretches.assign(scratch.joints.size(), mat3(1));
    scratch.stretches[j] = part.stretch;
  }
}

}  // namespace

vec3 eval_fold_normal(const SkinFolds& folds, uint32_t group, const std::vector<vec3>& positions) {
  vec3 sum(0);
  for (uint32_t k = folds.first[group]; k < folds.first[group + 1]; k++) {
    uvec3 t = folds.triangles[k];
    sum += cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]);
  }
  return unit_or(sum, vec3(0));
}

void skin(const Character& character, const Pose& pose, const mat4& placement, SkinScratch& scratch,
          std::vector<vec3>& positions, std::vector<vec3>& normals) {
  size_t count = character.positions.size();
  if (scratch.folds.character != &character || scratch.folds.vertex_count != count)
    make_folds(character, scratch.folds);
  SkinFolds& folds = scratch.folds;
  eval_joints(character, pose, scratch.joints);

  // Displacers move vertices at rest.
  const std::vector<vec3>* rest = &character.positions;
  const std::vector<vec3>* rest_normals = &character.normals;
  bool displaced = false;
  for (size_t d = 0; d < std::min(pose.displacers.size(), character.displacers.size()); d++) {
    float weight = pose.displacers[d];
    if (weight == 0 || !std::isfinite(weight)) continue;
    if (!displaced) {
      scratch.displaced = character.positions;
      scratch.displaced_normals = character.normals;
      displaced = true;
    }
    const Displacer& displacer = character.displacers[d];
    for (size_t i = 0; i < displacer.vertices.size(); i++)
      scratch.displaced[displacer.vertices[i]] += displacer.displacements[i] * weight;
  }
  if (displaced) {
    rest = &scratch.displaced;
    rest_normals = &scratch.displaced_normals;
    // A vertex's own normal turns as the mean of the faces around it does.
    parallel_ranges(int(folds.group_count), 256, [&](int begin, int end) {
      for (int g = begin; g < end; g++) {
        vec3 now = eval_fold_normal(folds, uint32_t(g), *rest),
             before = folds.rest_normal[size_t(g)];
        folds.turn[size_t(g)] =
            now == before || now == vec3(0) || before == vec3(0) || dot(now, before) < -0.999f
                ? quat(1, 0, 0, 0)
                : glm::normalize(quat(1 + dot(before, now), cross(before, now)));
      }
    });
    for (size_t i = 0; i < folds.vertices.size(); i++) {
      uint32_t v = folds.vertices[i];
      scratch.displaced_normals[v] = folds.turn[folds.group[i]] * character.normals[v];
    }
  }

  scratch.rows.resize(scratch.joints.size());
  for (size_t j = 0; j < scratch.joints.size(); j++)
    scratch.rows[j] = glm::mat3x4(glm::transpose(placement * scratch.joints[j]));
  const glm::mat3x4* joint_rows = scratch.rows.data();
  bool dual = character.skinning == Skinning::dual_quaternion;
  mat4 after(1);
  if (dual) split_joints(placement, scratch, after);
  bool finish = dual && after != mat4(1);
  glm::mat4 after_rows = glm::transpose(after);
  bool mirrored = glm::determinant(mat3(placement)) < 0;
  positions.resize(count);
  normals.resize(count);
  parallel_ranges(int(count), 2048, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      size_t v = size_t(i);
      const JointWeight* begin_weight = character.weights.data() + character.first_weight[v];
      const JointWeight* end_weight = character.weights.data() + character.first_weight[v + 1];
      glm::mat3x4 m(0);
      if (!dual || end_weight - begin_weight == 1) {
        for (const JointWeight* w = begin_weight; w != end_weight; w++)
          m += joint_rows[w->joint] * w->weight;
      } else {
        m = blend_dual_quaternions(begin_weight, end_weight, scratch.rigid, scratch.stretches);
        if (finish) {
          glm::mat3x4 bent = m;
          for (int r = 0; r < 3; r++) {
            vec4 row = after_rows[r];
            m[r] = row.x * bent[0] + row.y * bent[1] + row.z * bent[2] + vec4(0, 0, 0, row.w);
          }
        }
      }
      vec4 p((*rest)[v], 1);
      positions[v] = {dot(m[0], p), dot(m[1], p), dot(m[2], p)};
      // Normals follow by the cofactors of the blended matrix: right for any blend and any scale.
      vec3 a(m[0]), b(m[1]), c(m[2]), n = (*rest_normals)[v];
      vec3 turned(dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n));
      normals[v] = unit_or(mirrored ? -turned : turned, n);
    }
  });
}

}  // namespace wellspring::avatar
