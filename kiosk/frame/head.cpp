// SPDX-License-Identifier: Apache-2.0
#include "kiosk/frame/head.h"

#include <cmath>

namespace wellspring::kiosk {

namespace {

// Returns the axes of upright pictures' camera in screen axes, as columns.
mat3 camera_axes(const Mount& mount) {
  const float s = std::sin(mount.pitch), c = std::cos(mount.pitch);
  const mat3 level(vec3(-1, 0, 0), vec3(0, -c, s), vec3(0, s, c));
  const float left = mount.roll - float(quarter_turns(mount)) * pi / 2;
  return level * mat3(glm::rotate(mat4(1), left, vec3(0, 0, 1)));
}

// Returns, as columns, right, up and towards the visitor of somebody at `camera` (screen axes), as
// if the lens were the screen.
mat3 lens_axes(const Mount& mount, vec3 camera) {
  vec3 out = camera_axes(mount) * camera;
  float length = glm::length(out);
  if (!(length > 1e-6f)) return mat3(1);
  out /= length;
  // The upright image stays upright: up is the camera's own, made square to the ray.
  vec3 up = -camera_axes(mount)[1];
  vec3 right = glm::cross(up, out);
  float across = glm::length(right);
  if (!(across > 1e-6f)) return mat3(1);
  right /= across;
  return {right, glm::cross(out, right), out};
}

}  // namespace

int quarter_turns(const Mount& mount) {
  const int turns = int(std::lround(mount.roll / (pi / 2)));
  return turns == -2 ? 2 : turns;
}

float focal_length(const Mount& mount, int width, int height) {
  const bool sideways = quarter_turns(mount) % 2 != 0;
  return float(sideways ? height : width) / (2 * std::tan(mount.fov / 2));
}

vec3 face_in_camera(const Box& box, float focal, int width, int height) {
  float z = focal * face_box_metres / box.width;
  float u = box.center_x(), v = box.y + eyes_in_box * box.height;
  return {(u - width / 2.f) * z / focal, (v - height / 2.f) * z / focal, z};
}

vec3 camera_to_screen(const Mount& mount, vec3 camera) {
  if (mount.mirrored) camera.x = -camera.x;
  return mount.offset + camera_axes(mount) * camera;
}

vec3 screen_to_camera(const Mount& mount, vec3 screen) {
  vec3 camera = glm::transpose(camera_axes(mount)) * (screen - mount.offset);
  if (mount.mirrored) camera.x = -camera.x;
  return camera;
}

mat3 rotation_matrix(vec3 a) {
  auto about = [](float angle, vec3 axis) { return mat3(glm::rotate(mat4(1), angle, axis)); };
  return about(-a.x, {0, 1, 0}) * about(a.y, {1, 0, 0}) * about(-a.z, {0, 0, 1});
}

vec3 yaw_pitch_roll(const mat3& m) {
  vec3 forward = -m[2];
  float pitch = std::asin(glm::clamp(forward.y, -1.f, 1.f));
  return {std::atan2(forward.x, -forward.z), pitch, std::atan2(-m[0].y, m[1].y)};
}

// A mirror image is undone first, so both functions below work in true camera axes.
namespace {
const mat3 flip(vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1));
vec3 unmirrored(const Mount& mount, vec3 camera) { return mount.mirrored ? flip * camera : camera; }
mat3 unmirrored(const Mount& mount, const mat3& seen) {
  return mount.mirrored ? flip * seen * flip : seen;
}
}  // namespace

vec3 rotation_on_screen(const Mount& mount, const mat3& seen, vec3 camera) {
  return yaw_pitch_roll(lens_axes(mount, unmirrored(mount, camera)) * unmirrored(mount, seen));
}

vec3 rotation_on_screen(const Mount& mount, const mat3& in_camera) {
  // A face's own right and up are the picture's left and up.
  const mat3 face(vec3(-1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1));
  return yaw_pitch_roll(camera_axes(mount) * unmirrored(mount, in_camera) * face);
}

mat3 rotation_as_seen(const Mount& mount, vec3 angles, vec3 camera) {
  return unmirrored(
      mount, glm::transpose(lens_axes(mount, unmirrored(mount, camera))) * rotation_matrix(angles));
}

vec3 rotation_to_center(vec3 position) {
  float length = glm::length(position);
  if (!(length > 1e-6f)) return vec3(0);
  vec3 forward = -position / length;
  return {std::atan2(forward.x, -forward.z), std::asin(glm::clamp(forward.y, -1.f, 1.f)), 0};
}

}  // namespace wellspring::kiosk
