// SPDX-License-Identifier: Apache-2.0
// Finds what the eye sees first, eight requests at a time, if that is Lambertian and met in air:
// the same as first_surface.h finds there, without what other materials need.
#pragma once
#include <span>
#include <vector>

#include "light/sample.h"
#include "light/sample/sample_light.h"

namespace wellspring::light {

struct LambertHit {
  uint32_t request = 0;  // number of the request
  vec3 position{0};
  vec3 normal{0}, face{0};  // shading and geometric normal, on the viewer's side
  vec3 origin{0};           // origin of a ray that leaves to the side of `face`
  float extent = 0;         // SurfacePlace::extent
};

struct LambertHits {
  std::vector<LambertHit> eyes;
  std::vector<uint32_t> nothing;  // requests that meet nothing: their samples are complete
  std::vector<uint32_t> others;   // requests that see something else: their samples are not touched
};
// Describes the samples of requests that see something Lambertian, or nothing.
LambertHits see_lambert(const Transport& transport, std::span<const Request> requests,
                        std::span<Sample> samples);

}  // namespace wellspring::light
