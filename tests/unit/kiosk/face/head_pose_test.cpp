// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/head_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/rng.h"

namespace wellspring::test {
namespace {

constexpr int width = 640, height = 480;
const float focal = focal_length({}, width, height);

// The model's face, turned (screen angles, radians) and placed (screen metres), as a level camera
// in the screen's middle sees it.
FaceMarks project(vec3 angles, vec3 position, const Mount& mount = {}) {
  FaceMarks marks;
  for (size_t k = 0; k < marks.size(); k++) {
    const vec3 p = face_point(k);
    // Its own right and up are the picture's left and up.
    const vec3 at = position + rotation_matrix(angles) * vec3(-p.x, -p.y, p.z);
    const vec3 camera = screen_to_camera(mount, at);
    marks[k] = vec2(camera.x, camera.y) / camera.z * focal + vec2(width, height) / 2.f;
  }
  return marks;
}

float gauss(Rng& rng) {
  return std::sqrt(-2 * std::log(1 - rng.uniform())) * std::cos(2 * pi * rng.uniform());
}

TEST(HeadPose, exact_landmarks_give_the_exact_pose) {
  for (float yaw : {-0.9f, -0.3f, 0.f, 0.5f})
    for (float pitch : {-0.4f, 0.f, 0.3f})
      for (float roll : {-0.5f, 0.2f}) {
        const vec3 angles{yaw, pitch, roll}, position{0.2f, -0.1f, 1.1f};
        auto pose = solve_head_pose(project(angles, position), focal, width, height);
        ASSERT_TRUE(pose) << yaw << ' ' << pitch << ' ' << roll;
        EXPECT_LT(glm::length(rotation_on_screen(Mount{}, pose->rotation) - angles), 1e-3f);
        EXPECT_LT(glm::length(camera_to_screen({}, pose->position) - position), 2e-3f);
        EXPECT_LT(pose->error, 1e-3f);
        EXPECT_EQ(trust_of_error(pose->error), 1);
      }
}

TEST(HeadPose, the_mount_is_taken_out_as_a_rotation) {
  Mount mount{.offset = {0.1f, 0.4f, 0}, .pitch = -0.35f};
  for (bool mirrored : {false, true}) {
    mount.mirrored = mirrored;
    const vec3 angles{0.5f, 0.1f, 0}, position{-0.2f, 0, 0.9f};
    FaceMarks marks = project(angles, position, mount);
    if (mirrored) {
      // A mirror image shows a face whose landmarks change sides.
      const FaceMarks other =
          project({-angles.x, angles.y, -angles.z},
                  {2 * mount.offset.x - position.x, position.y, position.z}, [&] {
                    Mount m = mount;
                    m.mirrored = false;
                    return m;
                  }());
      marks = other;
    }
    auto pose = solve_head_pose(marks, focal, width, height);
    ASSERT_TRUE(pose);
    EXPECT_LT(glm::length(rotation_on_screen(mount, pose->rotation) - angles), 2e-3f) << mirrored;
    EXPECT_LT(glm::length(camera_to_screen(mount, pose->position) - position), 2e-3f) << mirrored;
  }
}

// A pixel of noise on every landmark and four of them far off, fifty seeds: bounds are three times
// what a run shows.
TEST(HeadPose, noise_and_outliers_move_it_little) {
  double turn = 0, place = 0;
  const vec3 angles{0.3f, -0.1f, 0.1f}, position{0.1f, 0, 0.8f};
  for (uint64_t seed = 1; seed <= 50; seed++) {
    Rng rng(seed);
    FaceMarks marks = project(angles, position);
    for (vec2& p : marks) p += vec2(gauss(rng), gauss(rng));
    for (size_t k : {36u, 31u, 28u, 45u}) marks[k] += vec2(25, -20);
    auto pose = solve_head_pose(marks, focal, width, height);
    ASSERT_TRUE(pose) << seed;
    turn += glm::length(rotation_on_screen(Mount{}, pose->rotation) - angles) / 50;
    place += glm::length(camera_to_screen({}, pose->position) - position) / 50;
    EXPECT_LT(trust_of_error(pose->error), 1) << seed;
  }
  EXPECT_LT(turn, 0.15);
  EXPECT_LT(place, 0.05);
}

TEST(HeadPose, landmarks_that_are_no_face_are_refused) {
  FaceMarks marks;
  marks.fill({100, 100});
  EXPECT_FALSE(solve_head_pose(marks, focal, width, height));
  for (size_t k = 0; k < marks.size(); k++) marks[k] = {100 + float(k), 50};
  EXPECT_FALSE(solve_head_pose(marks, focal, width, height));
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), INFINITY}) {
    marks = project({}, {0, 0, 1});
    marks[40].y = bad;
    EXPECT_FALSE(solve_head_pose(marks, focal, width, height));
  }
  // Landmarks thrown about are no face that could be believed.
  Rng rng(3);
  for (vec2& p : marks) p = vec2(rng.uniform(), rng.uniform()) * 200.f;
  auto pose = solve_head_pose(marks, focal, width, height);
  EXPECT_TRUE(!pose || trust_of_error(pose->error) == 0);
}

}  // namespace
}  // namespace wellspring::test
