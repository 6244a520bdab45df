// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "avatar/figure/skin.h"
#include "base/rng.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

quat any_turn(Rng& rng) {
  quat q(rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f);
  return glm::normalize(q);
}
vec3 random_point(Rng& rng) {
  return 4.0f * vec3(rng.uniform(), rng.uniform(), rng.uniform()) - 2.0f;
}

mat4 rigid(quat turn, vec3 way) { return glm::translate(mat4(1), way) * glm::mat4_cast(turn); }

vec3 moved(const glm::mat3x4& rows, vec3 p) {
  vec4 q(p, 1);
  return {dot(rows[0], q), dot(rows[1], q), dot(rows[2], q)};
}

TEST(SkinDual, ABlendOfRigidJointsIsRigid) {
  Rng rng(7);
  for (int i = 0; i < 2000; i++) {
    std::vector<DualQuaternion> joints;
    std::vector<JointWeight> weights;
    float sum = 0;
    for (uint16_t j = 0; j < 4; j++) {
      quat turn = any_turn(rng);
      if (i % 5 == 0 && j) turn = -joints[0].real;  // antipodal twins of one turn
      joints.push_back(make_dual_quaternion(turn, random_point(rng)));
      weights.push_back({j, rng.uniform() + 1e-3f});
      sum += weights.back().weight;
    }
    for (JointWeight& w : weights) w.weight /= sum;
    glm::mat3x4 rows = blend_dual_quaternions(weights.data(), weights.data() + 4, joints, {});
    vec3 a = random_point(rng), b = random_point(rng);
    EXPECT_NEAR(glm::length(moved(rows, a) - moved(rows, b)), glm::length(a - b),
                2e-5f * (1 + glm::length(a - b)));
    vec3 x(rows[0]), y(rows[1]), z(rows[2]);
    EXPECT_NEAR(dot(cross(x, y), z), 1, 1e-4f);
  }
}

// Signs of quaternions mean nothing, nor does the order of joints of different weight.
TEST(SkinDual, SignsDoNotMatter) {
  Rng rng(8);
  for (int i = 0; i < 500; i++) {
    std::vector<DualQuaternion> joints, flipped;
    for (int j = 0; j < 3; j++) {
      joints.push_back(make_dual_quaternion(any_turn(rng), random_point(rng)));
      flipped.push_back({j % 2 ? -joints.back().real : joints.back().real,
                         j % 2 ? -joints.back().dual : joints.back().dual});
    }
    std::vector<JointWeight> weights{{0, 0.5f}, {1, 0.3f}, {2, 0.2f}},
        turned{{2, 0.2f}, {0, 0.5f}, {1, 0.3f}};
    vec3 p = random_point(rng);
    vec3 a = moved(blend_dual_quaternions(weights.data(), weights.data() + 3, joints, {}), p);
    EXPECT_LT(
        glm::length(
            a - moved(blend_dual_quaternions(weights.data(), weights.data() + 3, flipped, {}), p)),
        1e-4f);
    EXPECT_LT(
        glm::length(a -
                    moved(blend_dual_quaternions(turned.data(), turned.data() + 3, joints, {}), p)),
        1e-4f);
  }
}

TEST(SkinDual, OneJointIsItsMatrixWhateverItScales) {
  Rng rng(9);
  for (int i = 0; i < 500; i++) {
    mat4 m = rigid(any_turn(rng), random_point(rng));
    if (i % 3 == 1) m = glm::scale(m, vec3(0.2f + rng.uniform(), 0.2f + 3 * rng.uniform(), 1));
    if (i % 3 == 2) m = m * rigid(any_turn(rng), vec3(0)) * glm::scale(mat4(1), vec3(1, 2, 0.5f));
    RigidPart part = split_matrix(m);
    std::vector<JointWeight> one{{0, 1.0f}};
    glm::mat3x4 rows =
        blend_dual_quaternions(one.data(), one.data() + 1, {part.rigid}, {part.stretch});
    vec3 p = random_point(rng);
    EXPECT_LT(glm::length(moved(rows, p) - vec3(m * vec4(p, 1))), 2e-4f);
    EXPECT_LT(glm::length(part.stretch[0] - glm::transpose(part.stretch)[0]), 1e-4f) << "symmetric";
  }
}

TEST(SkinDual, FlatAndEmptyMatricesStayFinite) {
  for (const mat4& m : {glm::scale(mat4(1), vec3(0)), glm::scale(mat4(1), vec3(1, 0, 1)),
                        glm::scale(mat4(1), vec3(-1, 1, 1))}) {
    RigidPart part = split_matrix(m);
    EXPECT_NEAR(glm::length(part.rigid.real), 1, 1e-5f);
    for (int c = 0; c < 3; c++) EXPECT_TRUE(is_finite(part.stretch[c]));
  }
}

// The reason for all this: a limb twisted by half a turn keeps its thickness.
TEST(SkinDual, ATwistedLimbKeepsItsThickness) {
  Character c = test::load_text(test::small_skin());
  Pose pose = make_rest_pose(c);
  pose.rotations[1] = glm::angleAxis(pi * 0.999f, vec3(0, 1, 0));
  size_t half = 0;
  for (size_t v = 0; v < c.positions.size(); v++)
    if (c.first_weight[v + 1] - c.first_weight[v] == 2) half = v;
  c.positions[half] = {0.4f, 2, 0};
  SkinScratch scratch;
  std::vector<vec3> positions, normals;
  skin(c, pose, mat4(1), scratch, positions, normals);
  EXPECT_LT(glm::length(vec2(positions[half].x, positions[half].z)), 0.01f)
      << "linear blending wrings it out";
  c.skinning = Skinning::dual_quaternion;
  skin(c, pose, mat4(1), scratch, positions, normals);
  EXPECT_NEAR(glm::length(vec2(positions[half].x, positions[half].z)), 0.4f, 1e-3f);
  EXPECT_NEAR(positions[half].y, 2, 1e-4f);
  EXPECT_NEAR(glm::length(normals[half]), 1, 1e-4f);
  EXPECT_NEAR(std::abs(normals[half].x), 1, 0.01f) << "turned by half the twist";
}

TEST(SkinDual, PlacementsAndStretchesAsWithMatricesWhereOneJointMoves) {
  Character c = test::load_text(test::small_skin());
  Pose pose = make_rest_pose(c);
  pose.rotations[0] = glm::angleAxis(1.0f, normalize(vec3(1, 2, 3)));  // the whole figure
  pose.translation = {1, 2, 3};
  pose.stretches.assign(2, mat3(1));
  pose.stretches[0] = mat3(1.5f, 0.2f, 0, 0.2f, 0.8f, 0, 0, 0, 1);
  SkinScratch scratch;
  for (const mat4& placement :
       {mat4(1), rigid(glm::angleAxis(2.0f, vec3(0, 1, 0)), {5, 0, 1}),
        glm::scale(rigid(glm::angleAxis(2.0f, vec3(0, 1, 0)), {5, 0, 1}), vec3(2, 1, -1))}) {
    std::vector<vec3> linear, dual, linear_normals, dual_normals;
    c.skinning = Skinning::linear;
    skin(c, pose, placement, scratch, linear, linear_normals);
    c.skinning = Skinning::dual_quaternion;
    skin(c, pose, placement, scratch, dual, dual_normals);
    for (size_t v = 0; v < linear.size(); v++) {
      EXPECT_LT(glm::length(linear[v] - dual[v]), 1e-4f);
      EXPECT_LT(glm::length(linear_normals[v] - dual_normals[v]), 1e-4f);
    }
  }
}

TEST(SkinDual, TheFileMayAskForIt) {
  EXPECT_EQ(test::load_text(test::small_skin()).skinning, Skinning::linear);
  Character c = test::load_text(test::small_skin(
      "<MetadataString name='skinning' value='\"dual_quaternion\"' containerField='metadata'/>"));
  EXPECT_EQ(c.skinning, Skinning::dual_quaternion);
}

}  // namespace
}  // namespace wellspring::test
