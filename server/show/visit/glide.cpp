// SPDX-License-Identifier: Apache-2.0
#include "show/visit/glide.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

namespace {
constexpr float slow_seconds = 0.35f;  // how softly it slows down
}

Viewpoint advance_glide(Glide& glide, bool leaps, float dt) {
  dt = std::clamp(dt, 0.0f, 0.25f);
  glide.pace += (glide.most_pace - glide.pace) * (1 - std::exp(-dt / slow_seconds));
  glide.time = leaps ? glide.path->seconds : glide.time + double(dt * glide.pace);
  Viewpoint view = eval_camera_path(*glide.path, glide.time);
  if (glide.time >= glide.path->seconds) glide = {};
  return view;
}

}  // namespace wellspring::show
