// SPDX-License-Identifier: Apache-2.0
#include "world/view.h"

#include <cmath>

namespace wellspring::world {
namespace {

View make_view_from_axes(const Scene& scene, dvec3 position, vec3 forward, vec3 right, float fov,
                         int width, int height) {
  View view;
  view.position = vec3(position - scene.origin);
  if (!is_finite(view.position)) view.position = vec3(0);
  view.forward = forward;
  view.right = right;
  view.up = cross(right, forward);
  if (!std::isfinite(fov)) fov = 1;
  view.tan_half_fov = std::tan(0.5f * glm::clamp(fov, 1e-4f, pi - 1e-3f));
  view.width = glm::max(width, 1);
  view.height = glm::max(height, 1);
  return view;
}

}  // namespace

View make_view(const Scene& scene, dvec3 position, float yaw, float pitch, float fov, int width,
               int height) {
  return make_view(scene, {"", position, yaw, pitch, 0, fov}, width, height);
}

View make_view(const Scene& scene, const Viewpoint& at, int width, int height) {
  const float yaw = std::isfinite(at.yaw) ? at.yaw : 0;
  const float pitch = std::isfinite(at.pitch) ? at.pitch : 0;
  vec3 forward{-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
  vec3 right{std::cos(yaw), 0, -std::sin(yaw)};
  if (at.roll != 0 && std::isfinite(at.roll))
    right = std::cos(at.roll) * right + std::sin(at.roll) * cross(right, forward);
  return make_view_from_axes(scene, at.position, forward, right, at.fov, width, height);
}

View make_view_towards(const Scene& scene, dvec3 eye, dvec3 target, vec3 up, float fov, int width,
                       int height) {
  dvec3 line = target - eye;
  double length = glm::length(line);
  vec3 forward = std::isfinite(length) && length > 0 ? vec3(line / length) : vec3(0, 0, -1);
  if (!is_finite(up) || dot(up, up) == 0) up = vec3(0, 1, 0);
  vec3 right = cross(forward, normalize(up));
  if (dot(right, right) < 1e-8f) {  // parallel: take any other axis
    vec3 other = std::abs(forward.z) < 0.9f ? vec3(0, 0, -1) : vec3(0, 1, 0);
    right = cross(forward, other);
  }
  return make_view_from_axes(scene, eye, forward, normalize(right), fov, width, height);
}

Ray view_ray(const View& view, float x, float y) {
  float scale = 2 * view.tan_half_fov / float(view.height);
  vec2 axis = axis_place(view);
  vec3 direction =
      view.forward + view.right * ((x - axis.x) * scale) + view.up * ((axis.y - y) * scale);
  Ray ray;
  ray.origin = view.position;
  ray.direction = normalize(direction);
  ray.from_eye = true;
  ray.spread = scale;
  if (view.near > 0) ray.t_min = view.near * glm::length(direction);
  return ray;
}

float distance_to_fit(vec3 half, vec3 back, float tan_x, float tan_y) {
  vec3 aside = cross(vec3(0, 1, 0), back);
  vec3 right = glm::length(aside) > 1e-6f ? normalize(aside) : vec3(1, 0, 0);
  vec3 up = cross(back, right);
  float distance = 1e-3f;
  for (int corner = 0; corner < 8; corner++) {
    vec3 p = half * vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    float towards = dot(p, back);
    distance = std::max(distance, std::abs(dot(p, right)) / tan_x + towards);
    distance = std::max(distance, std::abs(dot(p, up)) / tan_y + towards);
  }
  return distance;
}

}  // namespace wellspring::world
