// SPDX-License-Identifier: Apache-2.0
// A scene in a few lines, for tests of the render cache without a World: a room with a textured
// floor and pictures on a wall, three matt spheres, a mirror sphere, a lamp in the ceiling and a
// sharp spot light. Answers requests as a path tracer would, one noisy path a sample.
#pragma once
#include <span>
#include <vector>

#include "base/rng.h"
#include "frame/frame.h"
#include "light/sample.h"
#include "light/see.h"
#include "world/view.h"

namespace wellspring {

struct Room {
  bool lamp = true, spot = true;
  bool noisy = true;    // false: smooth light is a plain function of the place, no randomness
  vec3 ball_offset{0};  // moves the first sphere
  int bounces = 3;
};

Sample trace_room(const Room& room, const Request& request);
void trace_room(const Room& room, std::span<const Request> requests, std::vector<Sample>& samples);
void see_room(const Room& room, std::span<const Ray> rays, std::vector<Seen>& seen);
// `spp` jittered samples a pixel.
Frame render_room(const Room& room, const View& view, int spp, uint64_t seed = 99);
// Looking from `eye` at `target`, up +Y.
View look_at(vec3 eye, vec3 target, float fov_degrees, int width, int height);

}  // namespace wellspring
