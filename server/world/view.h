// SPDX-License-Identifier: Apache-2.0
// Describes a camera for one picture: where, which way, how wide. A value; made afresh each tick.
#pragma once
#include "base/vec.h"
#include "world/world.h"

namespace wellspring::world {

// Holds a view with orthonormal axes; pixel (0,0) is the top left, pixel centres at +0.5. Position
// is relative to Scene::origin.
struct View {
  vec3 position{0};
  vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  float tan_half_fov = 0.5f;  // vertical: half of the picture's height at a depth of 1
  int width = 1, height = 1;
  // Place of the picture's middle at a depth of 1, to the right of the axis and above it. Not 0:
  // the eye is not opposite the middle of the window that it looks through.
  vec2 middle{0};
  // Depth along the axis from which on anything is shown: things before an object that is looked at
  // from all sides are cut away. 0: everything is shown. Light ignores it.
  float near = 0;
  bool operator==(const View&) const = default;
};

View make_view(const Scene& scene, const Viewpoint& at, int width, int height);
// Makes an upright view from yaw and pitch as in Viewpoint. `fov` vertical, radians, in (0, pi).
View make_view(const Scene& scene, dvec3 position, float yaw, float pitch, float fov, int width,
               int height);
// Makes a view towards a target; if `up` is parallel to the line of sight another is chosen.
View make_view_towards(const Scene& scene, dvec3 eye, dvec3 target, vec3 up, float fov, int width,
                       int height);
// Returns where the axis (`forward`) meets the picture, in pixels from its top left.
inline vec2 axis_place(const View& view) {
  float focal = 0.5f * float(view.height) / view.tan_half_fov;
  return {0.5f * float(view.width) - view.middle.x * focal,
          0.5f * float(view.height) + view.middle.y * focal};
}
// The dot product of a place (relative to the eye) with these is its distance to the right of the
// picture's middle and above it, at the place's depth.
inline vec3 right_of_middle(const View& view) { return view.right - view.middle.x * view.forward; }
inline vec3 above_middle(const View& view) { return view.up - view.middle.y * view.forward; }
// Returns the ray through picture position (x, y) in pixels; unit direction.
Ray view_ray(const View& view, float x, float y);
// Holds the picture position of a point and its depth along the axis; depth <= 0: behind.
struct Projected {
  float x, y, depth;
};
inline Projected project_point(const View& view, vec3 p) {
  vec3 d = p - view.position;
  float depth = dot(d, view.forward);
  float scale = float(view.height) * 0.5f / (view.tan_half_fov * depth);
  vec2 axis = axis_place(view);
  return {dot(d, view.right) * scale + axis.x, axis.y - dot(d, view.up) * scale, depth};
}

// Finds how far from a box an eye sees all of it.

// Returns the distance from the box's middle along the unit direction `back`, for a picture whose
// half sides at a depth of 1 are `tan_x` and `tan_y`; `half` are half the box's sides. At least a
// millimetre.
float distance_to_fit(vec3 half, vec3 back, float tan_x, float tan_y);

}  // namespace wellspring::world
