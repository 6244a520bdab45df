// SPDX-License-Identifier: Apache-2.0
// What of a material multiplies light that neighbours share.
#pragma once
#include <algorithm>

#include "light/light_walk.h"

namespace wellspring {

struct SplitReflectance {
  bool soft = false;  // rough gloss is filtered with the diffuse light
  vec3 albedo{0};
};

// The diffuse colour, or without a diffuse layer that of a rough metal.
inline SplitReflectance split_reflectance(const Bsdf& bsdf) {
  SplitReflectance split;
  bool diffuse = max_component(bsdf.diffuse) > 1e-4f;
  split.albedo = diffuse ? bsdf.diffuse : bsdf.metallic * bsdf.metal;
  split.soft = !has_sharp(bsdf, mirror_alpha) && !(max_component(bsdf.transmit) > 0) &&
               std::min({split.albedo.x, split.albedo.y, split.albedo.z}) > 0.02f;
  if (!diffuse && !split.soft) split.albedo = vec3(0);
  return split;
}

}  // namespace wellspring
