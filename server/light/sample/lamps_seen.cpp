// SPDX-License-Identifier: Apache-2.0
#include "light/sample/lamps_seen.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/random/place_key.h"
#include "light/sample/sample_light.h"
#include "light/random/warp.h"

namespace wellspring::light {
namespace {

constexpr int steps = 6;  // surfaces that a walk visits
constexpr uint32_t table_size = 1 << 17;
constexpr int batch = 1 << 13;         // walks between two looks at what is known
constexpr uint16_t enough_tests = 64;  // of a lamp from a cell

// What a walk found out at one of its places.
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

// Asks the lamps that might emit light there and of which the cell does not know enough yet.
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

// A walk over the scene's surfaces, which scatter it as Lambertian ones do, whatever they are;
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
      // Laplace's rule of succession: what was never seen may be.
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

}  // namespace wellspring::light
