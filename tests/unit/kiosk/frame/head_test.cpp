// SPDX-License-Identifier: Apache-2.0
#include "kiosk/frame/head.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

void expect_near(vec3 a, vec3 b, float limit) {
  EXPECT_NEAR(a.x, b.x, limit);
  EXPECT_NEAR(a.y, b.y, limit);
  EXPECT_NEAR(a.z, b.z, limit);
}

// A box whose eyes are at (u, v).
Box box_at(float u, float v, float side) {
  return {u - side / 2, v - eyes_in_box * side, side, side};
}

TEST(Head, a_known_box_gives_known_metres) {
  Mount mount{.fov = 90 * pi / 180};
  const float focal = focal_length(mount, 640, 480);
  EXPECT_NEAR(focal, 320, 1e-3f);
  // 57.6 pixels of 0.18 m at 320 pixels focal length: 1 m away.
  expect_near(face_in_camera(box_at(320, 240, 57.6f), focal, 640, 480), {0, 0, 1}, 1e-5f);
  expect_near(face_in_camera(box_at(480, 240, 57.6f), focal, 640, 480), {0.5f, 0, 1}, 1e-5f);
  expect_near(face_in_camera(box_at(320, 80, 28.8f), focal, 640, 480), {0, -1, 2}, 1e-5f);
}

TEST(Head, image_right_is_screen_left_and_image_top_is_up) {
  Mount mount;
  expect_near(camera_to_screen(mount, {0.3f, 0, 1}), {-0.3f, 0, 1}, 1e-6f);
  expect_near(camera_to_screen(mount, {0, -0.2f, 1}), {0, 0.2f, 1}, 1e-6f);
  mount.mirrored = true;
  expect_near(camera_to_screen(mount, {0.3f, 0, 1}), {0.3f, 0, 1}, 1e-6f);
}

TEST(Head, offset_and_pitch_of_the_camera) {
  Mount mount{.offset = {0.1f, 0.4f, 0.02f}};
  expect_near(camera_to_screen(mount, {0, 0, 1}), {0.1f, 0.4f, 1.02f}, 1e-6f);
  mount.pitch = -30 * pi / 180;  // down: what lies ahead of the lens lies lower
  expect_near(camera_to_screen(mount, {0, 0, 1}), {0.1f, 0.4f - 0.5f, 0.02f + std::sqrt(0.75f)},
              1e-5f);
  for (bool mirrored : {false, true}) {
    mount.mirrored = mirrored;
    vec3 p{0.3f, -0.2f, 1.4f};
    expect_near(camera_to_screen(mount, screen_to_camera(mount, p)), p, 1e-5f);
  }
}

TEST(Head, a_camera_on_its_side_has_its_field_of_view_upwards) {
  constexpr float degree = pi / 180;
  Mount mount{.fov = 90 * degree};
  for (const auto& [roll, turns] : {std::pair{0.f, 0},
                                    {40.f, 0},
                                    {85.f, 1},
                                    {-92.f, -1},
                                    {180.f, 2},
                                    {-180.f, 2},
                                    {-170.f, 2}}) {
    mount.roll = roll * degree;
    EXPECT_EQ(quarter_turns(mount), turns) << roll;
    EXPECT_NEAR(focal_length(mount, 480, 640), turns % 2 ? 320 : 240, 1e-3f) << roll;
  }
}

TEST(Head, what_a_turn_of_the_camera_leaves_is_taken_out_of_places_and_rotations) {
  constexpr float degree = pi / 180;
  for (bool mirrored : {false, true})
    for (float quarter : {0.f, 90.f, -90.f, 180.f}) {
      // Turned clockwise by 10 degrees more, the camera sees what is level turned the other way.
      const Mount level{.offset = {0.1f, 0.3f, 0}, .pitch = -0.2f, .mirrored = mirrored};
      Mount turned = level;
      turned.roll = (quarter + 10) * degree;
      const vec3 place{0.2f, -0.1f, 1.2f};
      const vec3 seen = screen_to_camera(turned, place), straight = screen_to_camera(level, place);
      const float angle = std::atan2(seen.y, seen.x) - std::atan2(straight.y, straight.x);
      EXPECT_NEAR(std::abs(angle), 10 * degree, 1e-3f) << quarter;
      expect_near(camera_to_screen(turned, seen), place, 1e-5f);
      const vec3 head{0.3f, -0.1f, 0.2f};
      const mat3 as_seen = rotation_as_seen(turned, head, seen);
      expect_near(rotation_on_screen(turned, as_seen, seen), head, 1e-4f);
    }
}

TEST(Head, angles_have_the_signs_of_the_message) {
  vec3 forward{0, 0, -1}, up{0, 1, 0};
  EXPECT_GT((rotation_matrix({0.3f, 0, 0}) * forward).x, 0.2f);  // yaw: to the screen's right
  EXPECT_GT((rotation_matrix({0, 0.3f, 0}) * forward).y, 0.2f);  // pitch: up
  EXPECT_GT((rotation_matrix({0, 0, 0.3f}) * up).x, 0.2f);       // roll: to the right shoulder
}

TEST(Head, angles_survive_the_matrix) {
  for (float yaw : {-1.2f, -0.3f, 0.f, 0.7f})
    for (float pitch : {-0.8f, 0.f, 0.5f})
      for (float roll : {-0.6f, 0.f, 0.4f})
        expect_near(yaw_pitch_roll(rotation_matrix({yaw, pitch, roll})), {yaw, pitch, roll}, 1e-5f);
}

// A face that looks straight into the lens from the side is turned by its bearing, not square to
// the screen.
TEST(Head, the_bearing_is_taken_out) {
  Mount mount;
  vec3 camera{0.5f, 0, 1};  // image right: on the screen's left, so it looks to the right
  vec3 angles = rotation_on_screen(mount, mat3(1), camera);
  expect_near(angles, {std::atan(0.5f), 0, 0}, 1e-5f);
  expect_near(rotation_to_center(camera_to_screen(mount, camera)), angles, 1e-5f);
}

TEST(Head, the_tilt_of_the_camera_is_taken_out_as_a_rotation) {
  Mount mount{.offset = {0, 0.4f, 0}, .pitch = -0.4f};
  // Looking into a camera that is above and tilted down, straight along its axis: looking up by as
  // much.
  expect_near(rotation_on_screen(mount, mat3(1), {0, 0, 1}), {0, 0.4f, 0}, 1e-5f);
  // A head turned by yaw alone is seen with pitch and roll, and comes back as yaw alone.
  for (bool mirrored : {false, true}) {
    mount.mirrored = mirrored;
    vec3 angles{0.6f, 0, 0}, camera{0.2f, 0.1f, 0.9f};
    mat3 seen = rotation_as_seen(mount, angles, camera);
    EXPECT_GT(std::abs(yaw_pitch_roll(seen).z), 0.05f);
    expect_near(rotation_on_screen(mount, seen, camera), angles, 1e-5f);
  }
}

TEST(Head, degenerate_input_stays_finite) {
  Mount mount;
  EXPECT_TRUE(is_finite(rotation_on_screen(mount, mat3(1), vec3(0))));
  EXPECT_TRUE(is_finite(rotation_on_screen(mount, mat3(1), vec3(0, 1, 0))));
  EXPECT_TRUE(is_finite(rotation_to_center(vec3(0))));
}

}  // namespace
}  // namespace wellspring::test
