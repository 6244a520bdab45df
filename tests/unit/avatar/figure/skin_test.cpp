// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "avatar/figure/skin.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

void expect_near(vec3 a, vec3 b, float tolerance = 1e-5f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

struct Posed {
  std::vector<vec3> positions, normals;
  SkinScratch scratch;
};

Posed pose_it(const Character& c, const Pose& pose, const mat4& placement = mat4(1)) {
  Posed posed;
  skin(c, pose, placement, posed.scratch, posed.positions, posed.normals);
  return posed;
}

// The vertex at a rest position.
size_t vertex_at(const Character& c, vec3 place) {
  for (size_t v = 0; v < c.positions.size(); v++)
    if (glm::length(c.positions[v] - place) < 1e-5f) return v;
  ADD_FAILURE() << "no vertex there";
  return 0;
}

TEST(Skin, RestPoseIsTheIdentity) {
  for (const std::string& text : {test::small_skin(), test::whole_figure()}) {
    Character c = test::load_text(text);
    Posed posed = pose_it(c, make_rest_pose(c));
    ASSERT_EQ(posed.positions.size(), c.positions.size());
    for (size_t v = 0; v < c.positions.size(); v++) {
      expect_near(posed.positions[v], c.positions[v]);
      expect_near(posed.normals[v], c.normals[v]);
    }
  }
}

TEST(Skin, BlendsJointsByWeight) {
  Character c = test::load_text(test::small_skin());
  Pose pose = make_rest_pose(c);
  pose.rotations[1] = glm::angleAxis(pi / 2, vec3(0, 0, 1));  // vl5 turns about (0, 1, 0)
  Posed posed = pose_it(c, pose);
  expect_near(posed.positions[vertex_at(c, {0, 0, 0})], {0, 0, 0});
  expect_near(posed.positions[vertex_at(c, {1, 2, 0})], {-1, 2, 0});
  // Half root (0 2 0), half vl5 (-1 1 0).
  expect_near(posed.positions[vertex_at(c, {0, 2, 0})], {-0.5f, 1.5f, 0});
}

TEST(Skin, JointsTurnAboutTheirCentresAndCarryTheirChildren) {
  Character c = test::load_text(test::small_skin());
  Pose pose = make_rest_pose(c);
  pose.translation = {0, 0, 3};
  pose.rotations[0] = glm::angleAxis(pi / 2, vec3(0, 1, 0));
  pose.rotations[1] = glm::angleAxis(pi, vec3(0, 1, 0)) * 2.0f;  // not unit: made so
  std::vector<mat4> joints;
  eval_joints(c, pose, joints);
  expect_near(vec3(joints[1] * vec4(1, 2, 0, 1)), {0, 2, 4});
  expect_near(vec3(joints[0] * vec4(1, 0, 0, 1)), {0, 0, 2});
  pose.rotations[1] = quat(NAN, NAN, NAN, NAN);
  eval_joints(c, pose, joints);
  EXPECT_TRUE(is_finite(vec3(joints[1] * vec4(1, 1, 1, 1))));
}

TEST(Skin, PlacementMovesPositionsAndTurnsNormals) {
  Character c = test::load_text(test::small_skin());
  mat4 placement = glm::translate(mat4(1), vec3(10, 0, 0)) *
                   glm::mat4_cast(glm::angleAxis(pi / 2, vec3(0, 1, 0)));
  placement = glm::scale(placement, vec3(1, 2, 1));
  Posed posed = pose_it(c, make_rest_pose(c), placement);
  size_t v = vertex_at(c, {1, 2, 0});
  expect_near(posed.positions[v], {10, 4, -1});
  expect_near(posed.normals[v], {1, 0, 0});
}

TEST(Skin, MirroringPlacementKeepsNormalsOutside) {
  Character c = test::load_text(test::small_skin());
  Posed posed = pose_it(c, make_rest_pose(c), glm::scale(mat4(1), vec3(1, 1, -1)));
  expect_near(posed.normals[0], {0, 0, -1});
}

TEST(Skin, DisplacersMoveBeforeJointsAndNormalsFollowTheFold) {
  Character c = test::load_text(test::small_skin(
      "<HAnimDisplacer name='rise' coordIndex='2 3' displacements='0 -2 2 0 -2 2'/>"));
  Pose pose = make_rest_pose(c);
  pose.displacers[0] = 0.5f;
  Posed half = pose_it(c, pose);
  expect_near(half.positions[vertex_at(c, {1, 2, 0})], {1, 1, 1});
  pose.displacers[0] = 1;
  Posed full = pose_it(c, pose);
  // The square now lies along z: its normal points down instead of to the front.
  expect_near(full.normals[vertex_at(c, {1, 2, 0})], {0, -1, 0}, 1e-4f);
  pose.rotations[0] = glm::angleAxis(pi / 2, vec3(1, 0, 0));
  Posed turned = pose_it(c, pose);
  expect_near(turned.positions[vertex_at(c, {1, 2, 0})], {1, -2, 0});
  pose.displacers[0] = NAN;
  for (vec3 p : pose_it(c, pose).positions) EXPECT_TRUE(is_finite(p));
}

TEST(Skin, ScratchMayBeUsedForAnotherFigure) {
  Character a = test::load_text(
      test::small_skin("<HAnimDisplacer name='x' coordIndex='3' displacements='0 0 1'/>"));
  Character b = test::load_text(test::whole_figure());
  SkinScratch scratch;
  std::vector<vec3> positions, normals;
  for (const Character* c : {&a, &b, &a}) {
    Pose pose = make_rest_pose(*c);
    for (float& w : pose.displacers) w = 1;
    skin(*c, pose, mat4(1), scratch, positions, normals);
    EXPECT_EQ(positions.size(), c->positions.size());
    for (vec3 n : normals) EXPECT_NEAR(glm::length(n), 1, 1e-4f);
  }
}

}  // namespace
}  // namespace wellspring::test
