// SPDX-License-Identifier: Apache-2.0
// Eyes that look to a known place, drawn by the camera's model.
#include "kiosk/face/eyes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wellspring::test {
namespace {

constexpr float focal = 550;
constexpr int width = 640, height = 480;

vec2 seen(vec3 at) { return vec2(at) / at.z * focal + vec2(width, height) / 2.f; }

// The mesh of a face at `pose` whose eyes look to `target` in camera axes. Corners of eyes are
// landmarks 36, 39, 42 and 45.
FaceMesh looking(const HeadPose& pose, vec3 target, float iris_pixels) {
  FaceMesh mesh;
  mesh.irises.emplace();
  constexpr size_t corners[2][2] = {{36, 39}, {42, 45}};
  for (size_t eye = 0; eye < 2; eye++) {
    const vec3 between = (face_point(corners[eye][0]) + face_point(corners[eye][1])) / 2.f;
    const vec3 ball = pose.position + pose.rotation * (between + vec3(0, 0, 0.0105f));
    const vec2 at = seen(ball + 0.0115f * glm::normalize(target - ball));
    const float r = iris_pixels / 2;
    (*mesh.irises)[eye] = {at, at + vec2(r, 0), at - vec2(0, r), at - vec2(r, 0), at + vec2(0, r)};
  }
  return mesh;
}

TEST(Eyes, WhereTheyLookIsKnown) {
  for (const vec3 place : {vec3(0, 0, 0.6f), vec3(0.2f, -0.1f, 0.9f)})
    for (const vec3 target : {vec3(0), vec3(0.2f, 0.1f, 0), vec3(-0.15f, 0.2f, 0)}) {
      HeadPose pose;
      pose.position = place;
      const FaceMesh mesh = looking(pose, target, 12);
      const auto look = look_direction(mesh, pose, focal, width, height);
      ASSERT_TRUE(look);
      const float off = std::acos(glm::dot(*look, glm::normalize(target - place)));
      EXPECT_LT(off, 0.06f) << "eyes squint at what is near";
    }
}

TEST(Eyes, IrisesAreMeasuredByTheirLongerAxis) {
  FaceMesh mesh = looking({mat3(1), {0, 0, 1}}, vec3(0), 8);
  EXPECT_NEAR(*iris_width(mesh), 8, 1e-4);
  for (auto& iris : *mesh.irises) iris[2] = iris[0], iris[4] = iris[0];
  EXPECT_NEAR(*iris_width(mesh), 8, 1e-4);
  EXPECT_FALSE(iris_width(FaceMesh{}));
  EXPECT_FALSE(open_lids(FaceMesh{}));
  EXPECT_FALSE(look_direction(FaceMesh{}, {}, focal, width, height));
}

// Irises of a face of that size, as the network reads them, which is somewhat too narrow.
float iris_at(float distance) { return 0.93f * iris_metres * focal / distance; }

FaceSize looked_at(float distance, float size, int looks = 20) {
  FaceSize out;
  HeadPose pose;
  pose.position = {0, 0, distance / size};  // an adult's face of that picture
  for (int k = 0; k < looks; k++) add_look(out, iris_at(distance), focal, pose);
  return out;
}

TEST(Eyes, AChildIsNotTakenForAnAdultFarAway) {
  EXPECT_EQ(size_of(FaceSize{}), 1);
  EXPECT_NEAR(size_of(looked_at(0.7f, 0.82f)), 0.82f, 0.04f);
  // An iris that is read too wide or too narrow does not move adults.
  EXPECT_NEAR(size_of(looked_at(0.7f, 0.95f)), 1, 0.03f);
  EXPECT_NEAR(size_of(looked_at(0.7f, 1.05f)), 1, 0.025f);
}

TEST(Eyes, SmallIrisesAndTurnedFacesTellNoSize) {
  FaceSize size = looked_at(0.7f, 0.82f);
  const float before = size_of(size);
  HeadPose pose;
  pose.position = {0, 0, 1};
  add_look(size, 5, focal, pose), add_look(size, std::nanf(""), focal, pose);
  add_look(size, 8, 0, pose);
  const float yaw = 0.5f;
  pose.rotation = mat3(std::cos(yaw), 0, -std::sin(yaw), 0, 1, 0, std::sin(yaw), 0, std::cos(yaw));
  add_look(size, 8, focal, pose);
  EXPECT_EQ(size_of(size), before);
}

TEST(Eyes, ManyLooksStayFinite) {
  FaceSize size = looked_at(0.5f, 0.82f, 100000);
  EXPECT_TRUE(std::isfinite(size_of(size)));
  HeadPose pose;
  pose.position = {0, 0, 0.5f};
  for (int k = 0; k < 2000; k++) add_look(size, iris_at(0.5f), focal, pose);
  EXPECT_NEAR(size_of(size), 1, 0.02f) << "it learns anew";
}

TEST(Eyes, LidsAndLips) {
  FaceMesh mesh = looking({mat3(1), {0, 0, 1}}, vec3(0), 8);
  mesh.lids = {0.3f, 0.3f};
  EXPECT_EQ(*open_lids(mesh), 1);
  mesh.lids = {0.02f, 0.04f};
  EXPECT_EQ(*open_lids(mesh), 0);
  EXPECT_EQ(open_mouth(mesh), 0) << "a mesh without width";
  mesh.points[308] = {50, 0, 0}, mesh.points[14] = {25, 35, 0}, mesh.points[13] = {25, 0, 0};
  EXPECT_NEAR(open_mouth(mesh), 1, 1e-5);
}

}  // namespace
}  // namespace wellspring::test
