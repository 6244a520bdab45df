// SPDX-License-Identifier: Apache-2.0
// The point lights of a pass: section 4.4 of the paper. All sets and passes of one seed draw from one
// randomised low-discrepancy sequence, each a subsequence after the other's, dimensions padded by
// replication (Kollig and Keller 2001): that is Sampler.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/caustic_photons.h"
#include "light/emission.h"
#include "light/instant_radiosity.h"
#include "light/warp.h"

namespace wellspring {
namespace {

constexpr uint64_t place_stream = 0x706c616365ull, walk_stream = 0x77616c6bull,
                   photon_stream = 0x70686f746full;

struct DrawnSet {
  std::vector<PointLight> lights;
  std::vector<Arrival> arrivals;
};

void add_exact(const LightTables& tables, DrawnSet& set) {
  if (!tables.emission.exact_punctual) return;
  for (size_t i = 0; i < tables.punctual.size(); i++) {
    PointLight light;
    light.kind = PointLightKind::punctual;
    light.exact = true;
    light.index = uint32_t(i);
    light.radiance = vec3(1);
    set.lights.push_back(light);
  }
}

// A place on a source: of depth 0. `share`: of the source's light that it stands for.
void add_place(const Transport& transport, float share, Sampler& sampler, DrawnSet& set) {
  const LightTables& tables = transport.tables;
  const AliasTable& choice = tables.emission.places;
  vec2 u = sampler.next2();
  AliasPick pick = sample_alias(choice, u.x);
  float chance = choice.cells[pick.index].probability;
  if (!(chance > 0)) return;
  size_t triangles = tables.emitters.size(), punctual = tables.punctual.size();
  PointLight light;
  if (pick.index < triangles) {
    EmitterPlace place =
        eval_emitter_place(transport, pick.index, sample_triangle({pick.u, u.y}));
    light.position = place.surface.position;
    light.normal = place.surface.geometric_normal;
    light.target = offset_origin(place.surface, light.normal);
    light.double_sided = place.double_sided;
    light.radiance = place.radiance * (tables.emitters[pick.index].area * share / chance);
  } else if (pick.index < triangles + punctual) {
    light.kind = PointLightKind::punctual;
    light.index = uint32_t(pick.index - triangles);
    light.radiance = vec3(share / chance);
  } else {
    EnvironmentSample sky = sample_whole_sky(tables.environment, {pick.u, u.y});
    if (!(sky.pdf > 0)) return;
    light.kind = PointLightKind::distant;
    light.position = sky.direction;
    light.radiance =
        eval_environment(tables.environment, sky.direction) * (share / (sky.pdf * chance));
  }
  if (max_component(light.radiance) > 0 && is_finite(light.radiance)) set.lights.push_back(light);
}

void add_arrival(const LightWalk& walk, const Arrival& arrival, float share, DrawnSet& set) {
  const Bsdf& bsdf = arrival.bsdf;
  if (!arrival.lit || !has_rough(bsdf, sharp_alpha)) return;
  PointLight light;
  light.depth = uint16_t(walk.depth);
  light.position = arrival.surface.position;
  light.normal = arrival.surface.geometric_normal;
  light.target = offset_origin(arrival.surface, light.normal);
  if (!has_specular(bsdf) && bsdf.normal == bsdf.geometric_normal) {
    light.radiance = arrival.flux * share * bsdf.diffuse / pi;
  } else {
    light.kind = PointLightKind::scattering;
    light.index = uint32_t(set.arrivals.size());
    light.radiance = arrival.flux * share;
    light.double_sided = max_component(bsdf.transmit) > 0;
    set.arrivals.push_back(arrival);
  }
  if (max_component(light.radiance) > 0 && is_finite(light.radiance)) set.lights.push_back(light);
}

void add_walk(const Transport& transport, int deepest, float share, Sampler& sampler,
              DrawnSet& set) {
  EmittedRay emitted = sample_emitted_ray(transport, sampler);
  LightWalk walk;
  walk.ray = emitted.ray;
  walk.flux = emitted.flux;
  walk.range = emitted.range;
  Arrival arrival;
  while (walk.depth <= deepest && arrive(transport, walk, arrival)) {
    add_arrival(walk, arrival, share, set);
    if (!arrival.lit) return;
    BsdfSample scattered = sample_bsdf(arrival.bsdf, Lobes::all, sampler);
    if (!scatter(walk, arrival, scattered, sampler)) return;
  }
}

// Typical length of a ray between surfaces, from a few walks that are the same for every pass: the
// clipped picture that passes converge to is one picture.
float free_path(const Transport& transport) {
  constexpr int walks = 64, bounces = 3;
  std::vector<float> lengths;
  for (uint32_t i = 0; i < walks; i++) {
    Sampler sampler(mix64(0x66726565ull), i);
    EmittedRay emitted = sample_emitted_ray(transport, sampler);
    LightWalk walk;
    walk.ray = emitted.ray;
    walk.flux = emitted.flux;
    Arrival arrival;
    for (int bounce = 0; bounce < bounces && arrive(transport, walk, arrival); bounce++) {
      bool from_outside = bounce == 0 && walk.run > 2 * transport.tables.emission.radius;
      if (!from_outside) lengths.push_back(walk.run);
      if (!arrival.lit) break;
      walk.ray.direction = arrival.surface.geometric_normal;
      walk.ray.origin = offset_origin(arrival.surface, walk.ray.direction);
      walk.run = 0;
    }
  }
  if (lengths.empty()) return 0;
  std::nth_element(lengths.begin(), lengths.begin() + long(lengths.size() / 2), lengths.end());
  return lengths[lengths.size() / 2];
}

void draw_photons(const Transport& transport, const TransportSettings& settings, float radius,
                  uint64_t seed, uint32_t index, InstantPass& pass) {
  std::vector<CasterSphere> casters = find_casters(transport.world, transport.tables.plan, true);
  casters.insert(casters.end(), transport.tables.casters.begin(), transport.tables.casters.end());
  int photons = std::clamp(settings.instant.photons, 0, 1 << 22);
  if (casters.empty() || !(radius > 0) || photons == 0) return;
  constexpr int pieces = 4;  // of a set's photons, so that all cores have work
  std::vector<std::vector<Photon>> shot(size_t(pass.sets() * pieces));
  parallel_for(pass.sets() * pieces, [&](int i) {
    int set = i / pieces, piece = i % pieces;
    int begin = int(int64_t(photons) * piece / pieces),
        end = int(int64_t(photons) * (piece + 1) / pieces);
    uint32_t before = (index * uint32_t(pass.sets()) + uint32_t(set)) * uint32_t(photons);
    shot[size_t(i)] = shoot_caustic_photons(transport, casters, settings.max_depth,
                                            mix64(seed ^ photon_stream), before + uint32_t(begin),
                                            end - begin, 1 / float(photons));
  });
  pass.photons.resize(size_t(pass.sets()));
  parallel_for(pass.sets(), [&](int set) {
    std::vector<Photon> all;
    for (int piece = 0; piece < pieces; piece++) {
      const std::vector<Photon>& part = shot[size_t(set * pieces + piece)];
      all.insert(all.end(), part.begin(), part.end());
    }
    pass.photons[size_t(set)] = make_photon_grid(all, radius);
  });
}

}  // namespace

InstantPass draw_instant_pass(const Transport& transport, const TransportSettings& settings,
                              int picture_width, uint64_t seed, uint32_t index) {
  const InstantRadiositySettings& s = settings.instant;
  const LightTables& tables = transport.tables;
  InstantPass pass;
  pass.columns = std::clamp(s.columns, 1, 7);
  pass.rows = std::clamp(s.rows, 1, 7);
  pass.width = std::max(picture_width, 1);
  pass.compensate = s.compensate;
  pass.sharp = tables.plan.uses(TransportPart::caustics);
  int places = tables.emission.places.cells.empty() ? 0 : std::clamp(s.places, 0, 1 << 16);
  int walks = tables.emission.rays.cells.empty() ? 0 : std::clamp(s.walks, 0, 1 << 16);
  // A point light stands for the surface around it. Nearer than that surface is wide, about
  // sqrt(area / lights), the estimate is one of nothing but that light.
  bool needs_size = s.clip < 0 || (pass.sharp && !(s.photon_radius > 0));
  float size = needs_size ? free_path(transport) : 0;
  pass.clip = s.clip >= 0 ? s.clip : 2 * size / std::sqrt(float(pass.sets() * std::max(walks, 1)));

  std::vector<DrawnSet> sets(size_t(pass.sets()));
  parallel_for(pass.sets(), [&](int k) {
    DrawnSet& set = sets[size_t(k)];
    add_exact(tables, set);
    uint32_t before = index * uint32_t(pass.sets()) + uint32_t(k);
    for (int i = 0; i < places; i++) {
      Sampler sampler(mix64(seed ^ place_stream), before * uint32_t(places) + uint32_t(i));
      add_place(transport, 1 / float(places), sampler, set);
    }
    for (int i = 0; i < walks; i++) {
      Sampler sampler(mix64(seed ^ walk_stream), before * uint32_t(walks) + uint32_t(i));
      add_walk(transport, settings.max_depth - 2, 1 / float(walks), sampler, set);
    }
    std::stable_sort(set.lights.begin(), set.lights.end(),
                     [](const PointLight& a, const PointLight& b) { return a.depth < b.depth; });
  });
  float radius = s.photon_radius > 0 ? s.photon_radius : shrunk_radius(0.008f * size, index);
  if (pass.sharp) draw_photons(transport, settings, radius, seed, index, pass);
  for (DrawnSet& set : sets) {
    pass.first.push_back(uint32_t(pass.lights.size()));
    for (PointLight& light : set.lights) {
      if (light.kind == PointLightKind::scattering) light.index += uint32_t(pass.arrivals.size());
      pass.lights.push_back(light);
    }
    pass.arrivals.insert(pass.arrivals.end(), set.arrivals.begin(), set.arrivals.end());
  }
  pass.first.push_back(uint32_t(pass.lights.size()));
  return pass;
}

}  // namespace wellspring
