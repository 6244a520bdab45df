// SPDX-License-Identifier: Apache-2.0
// The punctual half of sample_light.h.
#include <algorithm>
#include <cmath>

#include "light/sample/lamps_seen.h"
#include "light/sample/sample_light.h"

namespace wellspring::light {

LightSample eval_punctual(const PunctualLight& punctual, const SpotCone& spot,
                          const SurfacePlace& from) {
  LightSample light;
  if (punctual.type == PunctualType::directional) {
    light.direction = -punctual.direction;
    light.radiance = punctual.intensity;
    light.pdf = 1;
    return light;
  }
  vec3 line = punctual.position - from.position;
  float distance2 = dot(line, line);
  if (!(distance2 > 1e-20f) || !std::isfinite(distance2)) return light;
  light.distance = std::sqrt(distance2);
  light.direction = line / light.distance;
  light.target = punctual.position;
  float strength = 1 / distance2;
  if (std::isfinite(punctual.range) && punctual.range > 0) {
    float ratio = light.distance / punctual.range, r2 = ratio * ratio;
    strength *= glm::clamp(1 - r2 * r2, 0.0f, 1.0f);
  }
  if (punctual.type == PunctualType::spot) {
    float cosine = -dot(light.direction, punctual.direction);
    float t = glm::clamp((cosine - spot.outer) * spot.scale, 0.0f, 1.0f);
    strength *= t * t;
  }
  light.radiance = punctual.intensity * strength;
  light.pdf = strength > 0 ? 1.0f : 0.0f;
  return light;
}

namespace {

// The distant one's chance. Two draws, near lights and distant ones, and then one of the two: the
// sun outshines every lamp wherever it would emit light, and indoors it rarely does, so it may not
// crowd the lamps out.
float distant_chance(float near_sum, float distant_sum) {
  if (near_sum == 0) return 1;
  if (distant_sum == 0) return 0;
  return 0.15f + 0.7f * distant_sum / (near_sum + distant_sum);
}

// Nothing was drawn, but others might have been.
LightSample unlucky() {
  LightSample light;
  light.share = 0;
  return light;
}

// Weighs the lamps' effects by what of them arrives there. False: nobody knows.
bool weigh_by_seen(const LightTables& tables, const LampsSeen& seen, const SurfacePlace& from,
                   LightEffects& effects) {
  const FewLights& few = tables.few_punctual;
  const LampsSeen::Shares* shares = find_lamps_seen(seen, from.position, from.geometric_normal);
  if (!shares) return false;
  effects.near_sum = effects.distant_sum = 0;
  for (int i = 0; i < few.count; i++) {
    effects.effect[i] *= float((*shares)[tables.punctual_index[size_t(i)]]) * (1 / 255.0f);
    (few.is_near[i] ? effects.near_sum : effects.distant_sum) += effects.effect[i];
  }
  return true;
}

LightSample draw_of_few(const Transport& transport, const SurfacePlace& from, vec3 normal,
                        bool through, const LobeHint& lobe, vec2 u) {
  const LightTables& tables = transport.tables;
  const FewLights& few = tables.few_punctual;
  LightEffects effects;
  eval_effects(few, from.position, normal, through, lobe, effects);
  if (!(effects.near_sum + effects.distant_sum > 0)) return {};
  float chance = distant_chance(effects.near_sum, effects.distant_sum);
  if (transport.lamps && !through && weigh_by_seen(tables, *transport.lamps, from, effects))
    chance = effects.distant_sum / (effects.near_sum + effects.distant_sum);
  bool distant = u.y < chance;
  float sum = distant ? effects.distant_sum : effects.near_sum, left = u.x * sum;
  int chosen = -1;
  for (int i = 0; i < few.count; i++) {
    if (few.is_near[i] == distant || !(effects.effect[i] > 0)) continue;
    chosen = i;
    if (left < effects.effect[i]) break;
    left -= effects.effect[i];
  }
  if (chosen < 0) return unlucky();
  LightSample light =
      eval_punctual(tables.punctual[size_t(chosen)], tables.cones[size_t(chosen)], from);
  light.share = effects.effect[chosen] * (distant ? chance : 1 - chance) / sum;
  light.radiance *= 1 / light.share;
  return light;
}

// What a light does to a surface, as eval_effects has it.
float effect_of(const LightSample& light, vec3 normal, bool through) {
  if (!(light.pdf > 0)) return 0;
  float cosine = dot(light.direction, normal);
  if (cosine <= 0 && !through) return 0;
  float effect = luminance(light.radiance) * (std::abs(cosine) + 0.05f);
  return std::isfinite(effect) ? effect : 0;
}

LightSample draw_of_many(const LightTables& tables, const SurfacePlace& from, vec3 normal,
                         bool through, vec2 u) {
  const LightTree* trees[] = {&tables.near_choice, &tables.distant_choice};
  LightSample lights[2];
  float share[2] = {1, 1}, sum[2] = {0, 0};
  for (int kind : {0, 1}) {
    if (trees[kind]->empty()) continue;
    // Behind the geometric surface nothing arrives; the tree knows no other side.
    vec3 side = through ? vec3(0) : from.geometric_normal;
    LightPick pick = pick_light(*trees[kind], from.position, side, u.x);
    if (!(pick.probability > 0)) continue;
    lights[kind] = eval_punctual(tables.punctual[pick.index], tables.cones[pick.index], from);
    share[kind] = 1 / pick.probability;
    sum[kind] = effect_of(lights[kind], normal, through) * share[kind];
  }
  if (!(sum[0] + sum[1] > 0)) return unlucky();
  float chance = distant_chance(sum[0], sum[1]);
  int kind = u.y < chance;
  lights[kind].share = (kind ? chance : 1 - chance) / share[kind];
  lights[kind].radiance *= 1 / lights[kind].share;
  return lights[kind];
}

}  // namespace

LightSample sample_punctual_light(const Transport& transport, const SurfacePlace& from, vec3 normal,
                                  bool through, Sampler& sampler, const LobeHint& lobe) {
  const LightTables& tables = transport.tables;
  if (tables.punctual.size() == 1) return eval_punctual(tables.punctual[0], tables.cones[0], from);
  if (tables.few_punctual.count > 0)
    return draw_of_few(transport, from, normal, through, lobe, sampler.next2());
  return draw_of_many(tables, from, normal, through, sampler.next2());
}

}  // namespace wellspring::light
