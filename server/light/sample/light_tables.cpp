// SPDX-License-Identifier: Apache-2.0
#include "light/sample/light_tables.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace wellspring::light {

SpotCone make_spot_cone(const PunctualLight& light) {
  float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
  return {outer, 1 / std::max(0.001f, inner - outer)};
}

FewLights make_few_lights(std::span<const PunctualLight> lights, std::span<const SpotCone> cones) {
  FewLights few{};
  if (lights.size() > size_t(FewLights::most)) return few;
  few.count = int(lights.size());
  for (size_t i = 0; i < lights.size(); i++) {
    const PunctualLight& light = lights[i];
    bool near = light.type != PunctualType::directional;
    bool spot = light.type == PunctualType::spot;
    bool ends = near && std::isfinite(light.range) && light.range > 0;
    vec3 place = near ? light.position : -light.direction;
    size_t g = i / lane_count, lane = i % lane_count;
    few.x[g][lane] = place.x, few.y[g][lane] = place.y, few.z[g][lane] = place.z;
    few.near[g][lane] = few.is_near[i] = near;
    few.axis_x[g][lane] = light.direction.x, few.axis_y[g][lane] = light.direction.y;
    few.axis_z[g][lane] = light.direction.z;
    few.outer[g][lane] = spot ? cones[i].outer : -3;
    few.scale[g][lane] = spot ? cones[i].scale : 1;
    few.range2_inverse[g][lane] = ends ? 1 / (light.range * light.range) : 0;
    few.strength[g][lane] = luminance(light.intensity);
  }
  return few;
}

void eval_effects(const FewLights& f, vec3 place, vec3 normal, bool through, const LobeHint& lobe,
                  LightEffects& effects) {
  // A share that does not depend on the lobe keeps a chance for what the lobe leaves out.
  constexpr float unknown = 0.05f;
  const float diffuse = lobe.diffuse + unknown * (lobe.diffuse + lobe.specular);
  const float alpha2 = lobe.alpha * lobe.alpha, upright = dot(normal, lobe.view);
  const float specular = lobe.specular * alpha2 / (4 * std::max(upright, 0.1f));
  const Lanes zero{}, one = all_lanes(1), least_cosine = all_lanes(through ? -2.0f : 0.0f);
  Lanes near_sum{}, distant_sum{};
  for (int g = 0; g * lane_count < f.count; g++) {
    Lanes x = f.x[g] - f.near[g] * place.x, y = f.y[g] - f.near[g] * place.y,
          z = f.z[g] - f.near[g] * place.z;
    Lanes distance2 = x * x + y * y + z * z, inverse = 1 / lanes_sqrt(distance2);
    Lanes ratio = distance2 * f.range2_inverse[g];
    Lanes window = lanes_max(1 - ratio * ratio, zero);
    Lanes along = -(x * f.axis_x[g] + y * f.axis_y[g] + z * f.axis_z[g]) * inverse;
    Lanes inside = lanes_min(lanes_max((along - f.outer[g]) * f.scale[g], zero), one);
    Lanes cosine = (x * normal.x + y * normal.y + z * normal.z) * inverse;
    Lanes scattered = diffuse * (lanes_abs(cosine) + 0.05f);
    if (lobe.specular > 0) {  // the squared cosine of the half vector, from |view + light|^2
      Lanes together =
          (x * lobe.view.x + y * lobe.view.y + z * lobe.view.z) * inverse * 2.0f + 2.0f;
      Lanes facing = upright + cosine;
      Lanes half2 = lanes_min(facing * facing / lanes_max(together, all_lanes(1e-6f)), one);
      Lanes spread = half2 * (alpha2 - 1) + 1.0f;
      scattered += specular / (spread * spread);
    }
    Lanes effect = f.strength[g] * window * (inside * inside) * scattered * (inverse * inverse);
    effect = cosine > least_cosine ? effect : zero;
    effect = effect < 3e38f ? effect : zero;  // a place on a light
    std::memcpy(effects.effect + g * lane_count, &effect, sizeof(effect));
    near_sum += effect * f.near[g];
    distant_sum += effect * (1 - f.near[g]);
  }
  effects.near_sum = lanes_sum(near_sum);
  effects.distant_sum = lanes_sum(distant_sum);
}

}  // namespace wellspring::light
