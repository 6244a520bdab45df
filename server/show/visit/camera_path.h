// SPDX-License-Identifier: Apache-2.0
// Holds the camera's trajectory along a way: position, yaw, pitch, roll and field of view as one
// cubic B-spline (twice continuously differentiable; de Boor 1978), and a law of time that keeps
// speed, turning and their changes comfortable everywhere, starting and ending at rest. Immutable.
#pragma once
#include <memory>
#include <vector>

#include "world/scene.h"

namespace wellspring::show {

struct CameraLimits {
  float speed = 1.2f;              // metres a second
  float turn = 0.698f;             // radians a second: 40 degrees, of yaw and of pitch
  float acceleration = 0.8f;       // metres a second squared, along the way
  float turn_acceleration = 1.2f;  // radians a second squared
};

struct CameraPath {
  struct Key {
    dvec3 position{0};  // absolute
    double yaw = 0, pitch = 0, roll = 0, fov = 1;
  };
  std::vector<Key> keys;      // control points
  std::vector<double> along;  // place on the spline at times i * step
  double step = 1.0 / 60, seconds = 0;
};

// Makes the path. `eyes`: where the eyes pass, the ends included, absolute and dense enough to be
// kept to; two equal points: a turn on the spot. The camera looks where it goes in between, if that
// is far enough. The path takes at least `least_seconds`, if there is any way to go.
CameraPath make_camera_path(const std::vector<dvec3>& eyes, const Viewpoint& from,
                            const Viewpoint& to, const CameraLimits& limits,
                            double least_seconds = 0);

// Returns the view at `time` seconds from the beginning; before and after it, the view at its ends.
// Yaw is within 2 pi of `to`'s.
Viewpoint eval_camera_path(const CameraPath& path, double time);

// Returns the radians that the camera turns within `seconds` from `time` on.
float turn_ahead(const CameraPath& path, double time, double seconds);

// Moves the camera on its way to where a visitor pointed. A glide is a value advanced by time.

// A glide is quicker than a tour: the visitor knows where it leads.
inline constexpr CameraLimits glide_limits{1.7f, 0.9f, 1.1f, 1.5f};

struct Glide {
  std::shared_ptr<const CameraPath> path;  // null: it is over
  double time = 0;                         // seconds on the path
  float pace = 1, most_pace = 1;  // shares of the path's own speed, 0 to 1, as in a TourRide
};

// Moves on by `dt` seconds, 0 to 0.25, or, if it leaps, to the end. Call it while there is a path.
Viewpoint advance_glide(Glide& glide, bool leaps, float dt);

}  // namespace wellspring::show
