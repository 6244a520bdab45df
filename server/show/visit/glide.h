// SPDX-License-Identifier: Apache-2.0
// The camera on its way to where a visitor pointed. A value advanced by time.
#pragma once
#include <memory>

#include "show/visit/camera_path.h"

namespace wellspring::show {

// Quicker than a tour: the visitor knows where it leads.
inline constexpr CameraLimits glide_limits{1.7f, 0.9f, 1.1f, 1.5f};

struct Glide {
  std::shared_ptr<const CameraPath> path;  // null: it is over
  double time = 0;                         // on the path
  float pace = 1, most_pace = 1;           // 0..1 of the path's own speed, as of a TourRide
};

// Moves on by `dt` seconds, 0 to 0.25, or, where it leaps, to the end. Call while there is a path.
Viewpoint advance_glide(Glide& glide, bool leaps, float dt);

}  // namespace wellspring::show
