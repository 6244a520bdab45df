// SPDX-License-Identifier: Apache-2.0
#include "light/technique/pixel_requests.h"

#include <algorithm>

#include "base/simd3.h"
#include "base/rng.h"
#include "light/random/sampler_simd.h"

namespace wellspring::light {
namespace {

// view_ray's directions, a place inside each pixel.
Lanes3 view_directions(const View& view, Lanes x, Lanes y) {
  const float scale = 2 * view.tan_half_fov / float(view.height);
  const vec2 axis = axis_place(view);
  Lanes along = (x - axis.x) * scale;
  Lanes upwards = (axis.y - y) * scale;
  Lanes3 way =
      all_lanes(view.forward) + all_lanes(view.right) * along + all_lanes(view.up) * upwards;
  return way * (1 / lanes_sqrt(dot(way, way)));
}

}  // namespace

void make_pixel_requests(const View& view, uint64_t seed, std::span<const PixelSample> which,
                         std::span<Request> requests) {
  uint64_t of_pixel = 0;
  for (size_t first = 0; first < which.size(); first += lane_count) {
    const int count = int(std::min(which.size() - first, size_t(lane_count)));
    SamplerLanes jitter;
    Lanes x{}, y{};
    for (int i = 0; i < count; i++) {
      const PixelSample& asked = which[first + size_t(i)];
      Request& request = requests[first + size_t(i)];
      const PixelSample* before = first + size_t(i) > 0 ? &which[first + size_t(i) - 1] : nullptr;
      if (!before || before->x != asked.x || before->y != asked.y)
        of_pixel = sample_seed(seed, uint32_t(asked.x), uint32_t(asked.y), 0);
      request = Request();
      request.pixel = uint32_t(asked.y) * uint32_t(view.width) + uint32_t(asked.x);
      request.seed = of_pixel;
      request.index = uint32_t(asked.index);
      request.ray.origin = view.position;
      request.ray.from_eye = true;
      // A sequence apart from the sample's own.
      jitter.set(i, Sampler(mix64(of_pixel ^ 0x6a09e667f3bcc909ull), request.index));
      x[i] = float(asked.x), y[i] = float(asked.y);
    }
    Lanes u, v;
    jitter.pair(LaneBits{}, u, v);
    Lanes3 way = view_directions(view, x + u, y + v);
    for (int i = 0; i < count; i++) requests[first + size_t(i)].ray.direction = way.at(i);
  }
}

}  // namespace wellspring::light
