// SPDX-License-Identifier: Apache-2.0
// What the eye sees first, eight requests at a time, where that is matt and met in air: what
// first_surface.h finds there, without what other materials need.
#pragma once
#include <span>
#include <vector>

#include "light/sample_light.h"
#include "light/sample.h"

namespace wellspring {

struct MattEye {
  uint32_t request = 0;  // number among those asked
  vec3 position{0};
  vec3 normal{0}, face{0};  // shading and geometric, on the viewer's side
  vec3 origin{0};           // of a ray that leaves to the side of `face`
  float extent = 0;         // SurfacePlace
};

// Describes the samples of those that see something matt, and appends them to `eyes`; the numbers of the
// others go to `others`.
void see_matt(const Transport& transport, std::span<const Request> requests,
              std::span<Sample> samples, std::vector<MattEye>& eyes, std::vector<uint32_t>& others);

}  // namespace wellspring
