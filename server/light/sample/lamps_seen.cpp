// SPDX-License-Identifier: Apache-2.0
#include "light/sample/lamps_seen.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/random/warp.h"
#include "light/sample/sample_light.h"

namespace wellspring::light {
namespace {

constexpr int steps = 6;  // surfaces that a walk visits
constexpr uint32_t table_size = 1 << 17;
constexpr int batch = 1 << 13;         // walks between two looks at the tallies
constexpr uint16_t enough_tests = 64;  // tests of a lamp from a cell

// Holds what a walk found at one of its places.
struct Visit {
  uint64_t key = 0;     // 0: nothing
  uint32_t tested = 0;  // bits of lamps
  std::array<float, FewLights::most> arrived{};
};
struct Tally {
  std::array<float, FewLights::most> arrived{};
  std::array<uint16_t, FewLights::most> tests{};
};

SurfacePlace place_of(const World& world, const Ray& ray, const Hit& hit) {
  Face face = make_face(world.placed(hit.instance), hit.triangle);
  SurfacePlace place;
  place.position = eval_position(world, hit.instance, hit.triangle, hit.barycentric);
  place.geometric_normal = dot(face.normal, ray.direction) > 0 ? -face.normal : face.normal;
  place.extent = face.extent;
  return place;
}

// Asks the lamps that might emit light there and for which the cell has not enough tests yet.
void visit(const Transport& transport, const LampsSeen& seen, const std::vector<Tally>& tallies,
           const SurfacePlace& place, Visit& to) {
  const LightTables& tables = transport.tables;
  to.key = place_key(place.position, place.geometric_normal, seen.cell);
  uint32_t slot = find_place_slot(seen.keys, to.key);
  const Tally* known = seen.keys[slot] != 0 ? &tallies[slot] : nullptr;
  LightEffects effects;
  eval_effects(tables.few_punctual, place.position, place.geometric_normal, false, {}, effects);
  for (int i = 0; i < tables.few_punctual.count; i++) {
    size_t lamp = size_t(i);
    if (!(effects.effect[lamp] > 0) || (known && known->tests[lamp] >= enough_tests)) continue;
    LightSample light = eval_punctual(tables.punctual[lamp], tables.cones[lamp], place);
    vec3 arrives = eval_visibility(transport, place, light);
    to.tested |= 1u << i;
    to.arrived[lamp] = glm::clamp(max_component(arrives), 0.0f, 1.0f);
  }
}

// Walks over the scene's surfaces, which scatter the walk as Lambertian ones do, whatever they are;
// glass lets it pass.
void walk_once(const Transport& transport, const LampsSeen& seen, const std::vector<Tally>& tallies,
               vec3 origin, Sampler& sampler, Visit* visits) {
  const World& world = transport.world;
  Ray ray;
  ray.origin = origin;
  ray.direction = sample_sphere(sampler.next2());
  for (int step = 0; step < steps; step++) {
    Hit hit = world.intersect(ray);
    if (!hit.valid()) return;
    SurfacePlace place = place_of(world, ray, hit);
    if (!world.is_moving(hit.instance) && world.material_of(hit.instance).transmission == 0) {
      visit(transport, seen, tallies, place, visits[step]);
      vec3 local = sample_cosine_hemisphere(sampler.next2()), n = place.geometric_normal;
      vec3 tangent, bitangent;
      make_frame_axes(n, tangent, bitangent);
      ray.direction = normalize(local.x * tangent + local.y * bitangent + local.z * n);
    }
    ray.origin = offset_origin(place, ray.direction);
  }
}

float choose_cell(const World& world, std::span<const vec3> places, uint64_t seed) {
  std::vector<float> lengths;
  for (size_t i = 0; i < places.size(); i++)
    for (uint32_t j = 0; j < 128; j++) {
      Sampler sampler(sample_seed(seed, uint32_t(i), j, 0));
      Ray ray;
      ray.origin = places[i];
      ray.direction = sample_sphere(sampler.next2());
      const Hit hit = world.intersect(ray);
      if (hit.valid()) lengths.push_back(hit.t);
    }
  if (lengths.empty()) return 1;
  const auto median = lengths.begin() + long(lengths.size() / 2);
  std::nth_element(lengths.begin(), median, lengths.end());
  return std::max(*median / 12, 1e-6f);
}

}  // namespace

std::shared_ptr<const LampsSeen> learn_lamps_seen(const Transport& transport,
                                                  std::span<const vec3> places,
                                                  const LampsSeenSettings& settings) {
  if (transport.tables.few_punctual.count < 2 || places.empty()) return nullptr;
  auto seen = std::make_shared<LampsSeen>();
  seen->cell =
      settings.cell > 0 ? settings.cell : choose_cell(transport.world, places, settings.seed);
  seen->keys.assign(table_size, 0);
  std::vector<Tally> tallies(table_size);
  std::vector<Visit> visits;
  size_t used = 0;
  for (int first = 0; first < settings.walks; first += batch) {
    int count = std::min(batch, settings.walks - first);
    visits.assign(size_t(count) * steps, Visit{});
    parallel_ranges(count, 32, [&](int begin, int end) {
      for (int i = begin; i < end; i++) {
        int walk = first + i;
        Sampler sampler(sample_seed(settings.seed, uint32_t(walk), 2, 0));
        walk_once(transport, *seen, tallies, places[size_t(walk) % places.size()], sampler,
                  &visits[size_t(i) * steps]);
      }
    });
    for (const Visit& one : visits) {
      if (one.key == 0) continue;
      uint32_t slot = find_place_slot(seen->keys, one.key);
      if (seen->keys[slot] == 0) {
        if (2 * (used + 1) > seen->keys.size()) continue;  // as much as the table is meant to hold
        seen->keys[slot] = one.key;
        used++;
      }
      for (size_t lamp = 0; lamp < FewLights::most; lamp++) {
        tallies[slot].tests[lamp] += one.tested >> lamp & 1;
        tallies[slot].arrived[lamp] += one.arrived[lamp];
      }
    }
  }
  seen->shares.resize(table_size);
  for (size_t slot = 0; slot < table_size; slot++)
    for (size_t lamp = 0; lamp < FewLights::most; lamp++) {
      // Laplace's rule of succession: a lamp that was never seen may still be seen.
      float share = (tallies[slot].arrived[lamp] + 1) / (float(tallies[slot].tests[lamp]) + 2);
      if (tallies[slot].tests[lamp] == 0) share = 1;
      seen->shares[slot][lamp] = uint8_t(std::clamp(share * 255 + 0.5f, 1.0f, 255.0f));
    }
  return seen;
}

const LampsSeen::Shares* find_lamps_seen(const LampsSeen& seen, vec3 position, vec3 normal) {
  uint32_t slot = find_place_slot(seen.keys, place_key(position, normal, seen.cell));
  return seen.keys[slot] != 0 ? &seen.shares[slot] : nullptr;
}

// Implements the punctual half of sample_light.h.

LightSample eval_punctual(const PunctualLight& punctual, const SpotCone& spot,
                          const SurfacePlace& from) {
  LightSample light;
  light.spectrum = punctual.spectrum;
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

// Returns the distant light's chance. There are two draws, from near lights and from distant ones,
// and then one of the two: the sun outshines every lamp wherever it would emit light, and indoors
// it rarely does, so it may not crowd the lamps out.
float distant_chance(float near_sum, float distant_sum) {
  if (near_sum == 0) return 1;
  if (distant_sum == 0) return 0;
  return 0.15f + 0.7f * distant_sum / (near_sum + distant_sum);
}

// Returns a sample for: nothing was drawn, but others might have been.
LightSample unlucky() {
  LightSample light;
  light.share = 0;
  return light;
}

// Weighs the lamps' effects by the share of each that arrives there. Returns false if no share was
// learned.
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

// Returns the effect of a light on a surface, as eval_effects has it.
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
