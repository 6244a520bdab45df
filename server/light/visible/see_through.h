// SPDX-License-Identifier: Apache-2.0
// What rays from the eye meet, without the light that falls there: for pictures whose light is
// known from elsewhere. A twentieth of a sample's cost.
#pragma once
#include <span>

#include "light/sample/lights.h"

namespace wellspring::light {

// As in the Sample a technique would give for the same ray, panes looked through.
struct PrimaryHit {
  vec3 normal{0};      // unit; towards the eye where nothing was hit
  float distance = 0;  // along the ray; infinity: nothing was hit
  vec3 albedo{0};
  vec3 glow{0};  // emission and sky: what is there of Sample::rest without any light falling
  uint32_t object = 0;
  bool scatters = false;  // else `glow` is all there is
};

// seen[i] answers rays[i]; neighbours side by side are quickest. All cores.
void see(const World& world, const Lights& lights, std::span<const Ray> rays,
         std::span<PrimaryHit> seen);

}  // namespace wellspring::light
