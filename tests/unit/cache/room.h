// SPDX-License-Identifier: Apache-2.0
// A room for tests of the render cache: a textured floor and pictures on a wall, three Lambertian
// spheres, a mirror sphere, a lamp in the ceiling and a sharp spot light. Answers requests as a
// path tracer would, one noisy path a sample, but by formulas.
#pragma once
#include <span>
#include <vector>

#include "base/rng.h"
#include "frame/frame.h"
#include "light/sample.h"
#include "world/view.h"

namespace wellspring::test {

struct Room {
  bool lamp = true, spot = true;
  bool noisy = true;  // false: smooth light is a plain function of the place, no randomness
  int bounces = 3;
};

Sample trace_room(const Room& room, const Request& request);
void trace_room(const Room& room, std::span<const Request> requests, std::vector<Sample>& samples);
// The same surfaces and objects as meshes: what is visible there.
Scene make_room_scene(const Room& room);
// `spp` jittered samples a pixel.
Frame render_room(const Room& room, const View& view, int spp, uint64_t seed = 99);
// Looking from `eye` at `target`, up +Y.
View look_at(vec3 eye, vec3 target, float fov_degrees, int width, int height);

}  // namespace wellspring::test
