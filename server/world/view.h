// SPDX-License-Identifier: Apache-2.0
// A camera for one picture: where, which way, how wide. A value; made afresh each tick.
#pragma once
#include "world/world.h"

namespace wellspring {

// Orthonormal axes; pixel (0,0) is the top left, pixel centres at +0.5. Position is relative to
// Scene::origin.
struct View {
  vec3 position{0};
  vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  float tan_half_fov = 0.5f;  // vertical
  int width = 1, height = 1;
  bool operator==(const View&) const = default;
};

// From yaw and pitch as in Viewpoint. `fov` vertical, radians, in (0, pi).
View make_view(const Scene& scene, dvec3 position, float yaw, float pitch, float fov, int width,
               int height);
// From a target; `up` may not be parallel to the line of sight (then another is chosen).
View make_view_towards(const Scene& scene, dvec3 eye, dvec3 target, vec3 up, float fov, int width,
                       int height);
// Ray through picture position (x, y) in pixels; unit direction.
Ray view_ray(const View& view, float x, float y);
// Picture position and depth along the axis of a point; depth <= 0: behind.
struct Projected {
  float x, y, depth;
};
inline Projected project_point(const View& view, vec3 p) {
  vec3 d = p - view.position;
  float depth = dot(d, view.forward);
  float scale = float(view.height) * 0.5f / (view.tan_half_fov * depth);
  return {dot(d, view.right) * scale + 0.5f * float(view.width),
          0.5f * float(view.height) - dot(d, view.up) * scale, depth};
}

}  // namespace wellspring
