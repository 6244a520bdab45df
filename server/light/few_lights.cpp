// SPDX-License-Identifier: Apache-2.0
#include "light/few_lights.h"

#include <algorithm>
#include <cmath>

namespace wellspring {

FewLights make_few_lights(std::span<const PunctualLight> lights, std::span<const SpotCone> cones) {
  FewLights few{};
  if (lights.size() > size_t(FewLights::most)) return few;
  few.count = int(lights.size());
  for (size_t i = 0; i < lights.size(); i++) {
    const PunctualLight& light = lights[i];
    bool near = light.type != PunctualType::directional;
    vec3 place = near ? light.position : -light.direction;
    few.x[i] = place.x, few.y[i] = place.y, few.z[i] = place.z;
    few.near[i] = near;
    few.axis_x[i] = light.direction.x, few.axis_y[i] = light.direction.y;
    few.axis_z[i] = light.direction.z;
    bool spot = light.type == PunctualType::spot;
    few.outer[i] = spot ? cones[i].outer : -3;
    few.scale[i] = spot ? cones[i].scale : 1;
    bool ends = near && std::isfinite(light.range) && light.range > 0;
    few.range2_inverse[i] = ends ? 1 / (light.range * light.range) : 0;
    few.strength[i] = luminance(light.intensity);
  }
  return few;
}

void eval_effects(const FewLights& f, vec3 place, vec3 normal, bool through,
                  LightEffects& effects) {
  constexpr int lanes = FewLights::lanes;
  const float least_cosine = through ? -2.0f : 0.0f;
  alignas(32) float near_sum[lanes]{}, distant_sum[lanes]{};
  for (int first = 0; first < f.count; first += lanes) {
    for (int lane = 0; lane < lanes; lane++) {
      int i = first + lane;
      float x = f.x[i] - f.near[i] * place.x, y = f.y[i] - f.near[i] * place.y,
            z = f.z[i] - f.near[i] * place.z;
      float distance2 = x * x + y * y + z * z, inverse = 1 / std::sqrt(distance2);
      float ratio = distance2 * f.range2_inverse[i];
      float window = std::max(1 - ratio * ratio, 0.0f);
      float along = -(x * f.axis_x[i] + y * f.axis_y[i] + z * f.axis_z[i]) * inverse;
      float inside = std::min(std::max((along - f.outer[i]) * f.scale[i], 0.0f), 1.0f);
      float cosine = (x * normal.x + y * normal.y + z * normal.z) * inverse;
      float effect = f.strength[i] * window * inside * inside * (std::abs(cosine) + 0.05f) *
                     (inverse * inverse);
      effect = cosine > least_cosine ? effect : 0.0f;
      effect = effect <= std::numeric_limits<float>::max() ? effect : 0.0f;  // a place on a light
      effects.effect[i] = effect;
      near_sum[lane] += effect * f.near[i];
      distant_sum[lane] += effect * (1 - f.near[i]);
    }
  }
  effects.near_sum = effects.distant_sum = 0;
  for (int lane = 0; lane < lanes; lane++) {
    effects.near_sum += near_sum[lane];
    effects.distant_sum += distant_sum[lane];
  }
}

}  // namespace wellspring
