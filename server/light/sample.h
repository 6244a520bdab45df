// SPDX-License-Identifier: Apache-2.0
// Defines what a technique is asked (Request) and what it answers (Sample). The answer keeps apart
// what the render cache treats differently: reflectance, light that is smooth and does not depend
// on the view, and the rest. Radiance towards the eye = albedo * (smooth * known - raised) + rest.
#pragma once
#include <cstdint>

#include "world/world.h"

namespace wellspring::light {

inline constexpr uint32_t no_cache_id = 0xffffffffu;
inline constexpr uint32_t no_pixel = 0xffffffffu;  // pixel of a request for what is not in view yet

struct Request {
  Ray ray;
  uint32_t pixel = 0;               // y * width + x of the view that asked, or no_pixel
  uint32_t resample = no_cache_id;  // cached point this ray passes exactly through, if any
  uint64_t seed = 0;   // names a sequence of samples that share a pixel, well spread among them
  uint32_t index = 0;  // in that sequence: the whole sample is a function of ray, seed and index
};

enum SampleFlags : uint8_t {
  sample_hit = 1,  // something was hit; else position is the ray's unit direction (at infinity)
  sample_specular = 2,  // a mirror, glass or polished metal: the picture there moves with the view
  sample_moving = 4,  // on a moving mesh: (instance, triangle, barycentric) place it in later ticks
  sample_sure =
      8,  // hint: `rest` owes next to nothing to chance, one more sample there would repeat it
  sample_mapped = 16,  // `known` is an illumination map's
};

// Clear thin panes (a vitrine's glass) are looked through: the sample describes what is behind
// them, `albedo` tinted by the panes, and `rest` carries their mirror image. Mirrors and solid
// glass are described where they are, with everything in `rest`.
struct Sample {
  vec3 position{0};    // hit point
  vec3 normal{0};      // shading normal, unit
  float distance = 0;  // along the ray; infinity: nothing was hit
  uint32_t object = 0;
  uint32_t instance = 0, triangle = 0;
  vec2 barycentric{0};
  vec3 albedo{0};  // diffuse reflectance, textured
  vec3 smooth{0};  // diffusely reflected light over albedo: indirect, area lights, environment
  vec3 rest{
      0};  // emission, specular, and diffusely reflected light of punctual lights (sharp shadows)
  // The part of `rest` that the surface, and panes before it, emit, if the surface reflects light,
  // too: a picture that is drawn (VisibilityPass) knows that exactly. 0 for the sky and for what
  // only emits light.
  vec3 glow{0};
  // The diffuse light of the surface by an illumination map (sample_mapped), else 1. `smooth`
  // counts in multiples of it, and the light of punctual lights is part of it.
  vec3 known{1};
  float raised = 0;  // light that `known` has beyond the map's; `smooth` counts it, too
  uint8_t flags = 0;
  // Light is not below zero but for hues beyond a display's (light/material/wavelengths.h), which
  // mix in the mean.
  vec3 radiance() const {
    return albedo * max(smooth * known - vec3(raised), min(smooth, vec3(0))) + rest;
  }
};

}  // namespace wellspring::light
