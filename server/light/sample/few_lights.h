// SPDX-License-Identifier: Apache-2.0
// Few punctual lights, side by side as vector units want them: what each does to a place is asked
// of all at once. glTF KHR_lights_punctual.
#pragma once
#include <span>

#include "base/simd.h"
#include "world/emitter.h"

namespace wellspring::light {

// A spot light's fall-off: clamp((cosine - outer) * scale), squared.
struct SpotCone {
  float outer = 0, scale = 1;
};
SpotCone make_spot_cone(const PunctualLight& light);

struct FewLights {
  static constexpr int most = 16, groups = most / lane_count;
  // Of a near light its place; of a distant one the direction towards it, and `near` is 0.
  Lanes x[groups], y[groups], z[groups], near[groups];
  Lanes axis_x[groups], axis_y[groups], axis_z[groups];
  Lanes outer[groups], scale[groups];  // all directions are in the cone of what is no spot
  Lanes range2_inverse[groups];        // 0: it reaches everywhere
  Lanes strength[groups];              // luminance; 0 beyond the last light
  bool is_near[most];
  int count = 0;  // 0: there are none, or more than `most`
};
FewLights make_few_lights(std::span<const PunctualLight> lights, std::span<const SpotCone> cones);

// What they do to a surface there, but for shadows; sums over near and distant ones. The floor
// keeps a chance for glossy lobes at grazing angles.
struct LightEffects {
  alignas(Lanes) float effect[FewLights::most];
  float near_sum = 0, distant_sum = 0;
};
// What a surface does with light, as far as the choice among lights asks: a Lambertian part and a
// GGX lobe of reflection. A highlight whose lamp is rarely chosen is a firefly.
struct LobeHint {
  float diffuse = 1, specular = 0;  // reflectances; specular 0: the rest is not set
  vec3 view{0};                     // towards the viewer, unit
  float alpha = 1;                  // squared perceptual roughness, > 0
};
// `through`: light from behind the surface counts too.
void eval_effects(const FewLights& lights, vec3 place, vec3 normal, bool through,
                  const LobeHint& lobe, LightEffects& effects);

}  // namespace wellspring::light
