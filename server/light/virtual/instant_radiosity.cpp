// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/instant_radiosity.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/virtual/caustic_photons.h"
#include "light/virtual/discontinuity_buffer.h"
#include "light/virtual/eye_light.h"
#include "light/virtual/virtual_lights.h"
#include "light/virtual/region_lights.h"
#include "light/random/warp.h"
#include "light/sample/caustic_casters.h"
#include "light/sample/emission.h"
#include "light/sample/light_tables.h"
#include "light/sample/transport.h"

namespace wellspring::light {
namespace {

constexpr int pixels_a_candidate = 2048;
// The first passes of a picture average irradiance over more than the paper's window; the mean of
// many passes has ever less of that blur.
constexpr uint32_t wide_passes = 4;

}  // namespace

void begin_instant(const World& world, const TransportSettings& settings, const View& view,
                   uint64_t seed, uint32_t index, Lights& lights) {
  // A small picture has no use for more photons than pixels, and choosing must cost less than it
  // saves.
  TransportSettings here = settings;
  int pixels = std::max(64, view.width * view.height);
  here.instant.photons = std::min(settings.instant.photons, pixels);
  here.instant.candidates =
      std::clamp(pixels / pixels_a_candidate, 1, std::max(1, settings.instant.candidates));
  if (here.instant.candidates == 1) here.instant.walks = std::max(1, settings.instant.walks / 4);
  auto pass = std::make_shared<InstantPass>(
      draw_instant_pass({world, *lights.tables}, here, view, seed, index));
  pass->settings = settings;
  pass->seed = seed;
  pass->index = index;
  lights.pass = std::move(pass);
}

void finish_instant(const World& world, const Lights& lights, const View& view,
                    std::span<Sample> samples) {
  if (!lights.pass) return;
  const InstantPass& pass = *lights.pass;
  DiscontinuitySettings settings;
  settings.columns = pass.columns;
  settings.rows = pass.rows;
  std::vector<uint8_t> edges;
  // Lists of lights interleave more coarsely than sets: the second window removes what is left of
  // their pattern.
  DiscontinuitySettings windows[2] = {settings, settings};
  windows[1].columns = windows[1].rows = windows[1].step = 3;
  bool both = pass.index < wide_passes && pass.sets() > 1;
  filter_windows(view, std::span(windows, both ? 2 : 1), samples, &edges);
  refine_edges(world, lights, pass.settings, view, settings, pass.settings.instant.edge_rays,
               mix64(pass.seed ^ 0x6564676573ull), pass.index, edges, samples);
}

// Draws the point lights of a pass: section 4.4 of the paper. All sets and passes of one seed draw
// from one randomised low-discrepancy sequence, each a subsequence after the other's, dimensions
// padded by replication (Kollig and Keller 2001), as Sampler does.

namespace {

constexpr uint64_t place_stream = 0x706c616365ull, walk_stream = 0x77616c6bull,
                   photon_stream = 0x70686f746full, probe_stream = 0x70726f6265ull,
                   choice_stream = 0x63686f696365ull, region_stream = 0x726567696f6eull;

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

// Adds a place on a source as a light of depth 0. `share`: part of the source's light that it
// stands for.
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
    EmitterPlace place = sample_emitter_place(transport, pick.index, {pick.u, u.y});
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

// Adds a walk's arrival as a light. `parted`: what the surface itself makes of the walk's colours.
void add_arrival(const LightWalk& walk, const Arrival& arrival, const WavelengthSpread* parted,
                 float share, DrawnSet& set) {
  const Bsdf& bsdf = arrival.bsdf;
  if (!arrival.lit || !has_rough(bsdf, sharp_alpha)) return;
  PointLight light;
  light.depth = uint16_t(walk.depth);
  light.hue = hue_of(walk.wavelengths);
  light.position = arrival.surface.position;
  light.normal = arrival.surface.geometric_normal;
  light.target = offset_origin(arrival.surface, light.normal);
  if (!has_specular(bsdf) && bsdf.normal == bsdf.geometric_normal) {
    light.radiance = arrival.flux * share * bsdf.diffuse / pi;
  } else {
    light.kind = PointLightKind::scattering;
    light.index = uint32_t(set.arrivals.size());
    light.radiance = arrival.flux * share;
    if (parted) {  // one wavelength for all that the light reaches
      light.radiance *= hero_tint(*parted);
      light.hue = parted->before.place;
    }
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
    std::optional<WavelengthSpread> spread;
    part_arrival(transport, walk, sampler, arrival, spread);
    add_arrival(walk, arrival, spread ? &*spread : nullptr, share, set);
    if (!arrival.lit || !scatter(walk, arrival, spread, Lobes::all, sampler)) return;
  }
}

// Returns the typical length of a ray between surfaces, from a few walks that are the same for
// every pass: the clipped picture that passes converge to is one picture.
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
  constexpr int pieces = 4;  // pieces of a set's photons, so that all cores have work
  std::vector<std::vector<Photon>> shot(size_t(pass.sets() * pieces));
  parallel_for(pass.sets() * pieces, [&](int i) {
    int set = i / pieces, piece = i % pieces;
    int begin = int(int64_t(photons) * piece / pieces),
        end = int(int64_t(photons) * (piece + 1) / pieces);
    uint32_t before = (index * uint32_t(pass.sets()) + uint32_t(set)) * uint32_t(photons);
    shot[size_t(i)] =
        shoot_caustic_photons(transport, casters, settings.max_depth, mix64(seed ^ photon_stream),
                              before + uint32_t(begin), end - begin, 1 / float(photons));
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

void sort_by_depth(DrawnSet& set) {
  std::stable_sort(set.lights.begin(), set.lights.end(),
                   [](const PointLight& a, const PointLight& b) { return a.depth < b.depth; });
}

// Appends `from` to `lights` and `arrivals`.
void append(const DrawnSet& from, std::vector<PointLight>& lights, std::vector<Arrival>& arrivals) {
  for (PointLight light : from.lights) {
    if (light.kind == PointLightKind::scattering) light.index += uint32_t(arrivals.size());
    lights.push_back(light);
  }
  arrivals.insert(arrivals.end(), from.arrivals.begin(), from.arrivals.end());
}

// Return the numbers to draw; zero if there is no source.
int places_of(const LightTables& tables, const InstantRadiositySettings& s) {
  return tables.emission.places.cells.empty() ? 0 : std::clamp(s.places, 0, 1 << 16);
}
int walks_of(const LightTables& tables, const InstantRadiositySettings& s) {
  return tables.emission.rays.cells.empty() ? 0 : std::clamp(s.walks, 0, 1 << 16);
}

InstantPass start_pass(const Transport& transport, const InstantRadiositySettings& s, int width) {
  InstantPass pass;
  pass.columns = std::clamp(s.columns, 1, 7);
  pass.rows = std::clamp(s.rows, 1, 7);
  pass.width = std::max(width, 1);
  pass.compensate = s.compensate;
  pass.sharp = transport.tables.plan.uses(TransportPart::caustics);
  return pass;
}

// A point light stands for the surface around it. Nearer than a few times that surface's width,
// about sqrt(area / lights), the estimate is one of few lights, which is noise that neighbours
// share: what a ray gathers instead is noise of each pixel, which the filter takes away.
float clip_distance(const InstantRadiositySettings& s, float size, int lights) {
  return s.clip >= 0 ? s.clip : size * std::min(0.25f, 5 / std::sqrt(float(std::max(lights, 1))));
}

float photon_radius(const InstantRadiositySettings& s, float size, uint32_t index) {
  return s.photon_radius > 0 ? s.photon_radius : shrunk_radius(0.008f * size, index);
}

void join_sets(const LightTables& tables, std::vector<DrawnSet>& sets, InstantPass& pass) {
  for (DrawnSet& set : sets) {
    sort_by_depth(set);
    pass.first.push_back(uint32_t(pass.lights.size()));
    append(set, pass.lights, pass.arrivals);
  }
  pass.first.push_back(uint32_t(pass.lights.size()));
  pass.lanes = std::make_shared<LightLanes>(make_light_lanes(tables, pass));
}

// A light of a pool that a set has besides its exact ones.
struct KeptPointLight {
  uint32_t light = 0;
  float factor = 1;  // factor on the light's radiance
};

// Makes every set of `exact` and then the lights that it keeps of the pool, by depth.
void join_kept(const LightTables& tables, const InstantPass& pool, const DrawnSet& exact,
               std::vector<std::vector<KeptPointLight>>& kept, InstantPass& pass) {
  std::vector<uint32_t> first_arrival(kept.size() + 1, 0);
  parallel_for(int(kept.size()), [&](int k) {
    std::vector<KeptPointLight>& lights = kept[size_t(k)];
    auto depth = [&](const KeptPointLight& one) { return pool.lights[one.light].depth; };
    std::stable_sort(
        lights.begin(), lights.end(),
        [&](const KeptPointLight& a, const KeptPointLight& b) { return depth(a) < depth(b); });
    first_arrival[size_t(k) + 1] =
        uint32_t(std::count_if(lights.begin(), lights.end(), [&](const KeptPointLight& one) {
          return pool.lights[one.light].kind == PointLightKind::scattering;
        }));
  });
  pass.first.assign(1, 0);
  for (size_t k = 0; k < kept.size(); k++) {
    pass.first.push_back(pass.first.back() + uint32_t(exact.lights.size() + kept[k].size()));
    first_arrival[k + 1] += first_arrival[k];
  }
  pass.lights.resize(pass.first.back());
  pass.arrivals.resize(first_arrival.back());
  parallel_for(int(kept.size()), [&](int k) {
    PointLight* to = &pass.lights[0] + pass.first[size_t(k)];
    to = std::copy(exact.lights.begin(), exact.lights.end(), to);
    uint32_t arrival = first_arrival[size_t(k)];
    for (const KeptPointLight& one : kept[size_t(k)]) {
      PointLight light = pool.lights[one.light];
      light.radiance *= one.factor;
      if (light.kind == PointLightKind::scattering) {
        pass.arrivals[arrival] = pool.arrivals[light.index];
        light.index = arrival++;
      }
      *to++ = light;
    }
  });
  pass.lanes = std::make_shared<LightLanes>(make_light_lanes(tables, pass));
}

// Draws the candidates of pass `index` from their two sequences, in parallel: `places` and `walks`.
void draw_candidates(const Transport& transport, int deepest, int places, int walks, uint64_t seed,
                     uint32_t index, InstantPass& pool) {
  constexpr int at_once = 32;
  int place_parts = (places + at_once - 1) / at_once, walk_parts = (walks + at_once - 1) / at_once;
  std::vector<DrawnSet> parts(size_t(place_parts + walk_parts));
  parallel_for(int(parts.size()), [&](int k) {
    bool place = k < place_parts;
    int begin = (place ? k : k - place_parts) * at_once,
        end = std::min(begin + at_once, place ? places : walks);
    for (int i = begin; i < end; i++) {
      uint32_t number = index * uint32_t(place ? places : walks) + uint32_t(i);
      Sampler sampler(mix64(seed ^ (place ? place_stream : walk_stream)), number);
      if (place) add_place(transport, 1 / float(places), sampler, parts[size_t(k)]);
      else add_walk(transport, deepest, 1 / float(walks), sampler, parts[size_t(k)]);
    }
  });
  for (const DrawnSet& part : parts) append(part, pool.lights, pool.arrivals);
}

}  // namespace

InstantPass draw_instant_pass(const Transport& transport, const TransportSettings& settings,
                              int picture_width, uint64_t seed, uint32_t index) {
  const InstantRadiositySettings& s = settings.instant;
  const LightTables& tables = transport.tables;
  InstantPass pass = start_pass(transport, s, picture_width);
  int places = places_of(tables, s), walks = walks_of(tables, s);
  bool needs_size = s.clip < 0 || (pass.sharp && !(s.photon_radius > 0));
  float size = needs_size ? free_path(transport) : 0;
  pass.clip = clip_distance(s, size, pass.sets() * std::max(walks, 1));
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
  });
  if (pass.sharp)
    draw_photons(transport, settings, photon_radius(s, size, index), seed, index, pass);
  join_sets(tables, sets, pass);
  return pass;
}

InstantPass draw_instant_pass(const Transport& transport, const TransportSettings& settings,
                              const View& view, uint64_t seed, uint32_t index) {
  constexpr int probe_count = 64, size_probes = 64;
  const InstantRadiositySettings& s = settings.instant;
  const LightTables& tables = transport.tables;
  if (s.candidates <= 1) return draw_instant_pass(transport, settings, view.width, seed, index);
  InstantPass pass = start_pass(transport, s, view.width), pool = pass;
  // The size is the same for every pass: the clipped picture that they converge to is one picture.
  float size = 0;
  if (s.clip < 0 || (pass.sharp && !(s.photon_radius > 0)))
    size = probe_free_path(transport, probe_view(transport, view, settings.max_depth, size_probes,
                                                 mix64(probe_stream), 0));
  pass.clip = pool.clip = clip_distance(s, size, pass.sets() * std::max(s.bounced, 1));

  int times = pass.sets() * std::min(s.candidates, 1 << 10);
  int places = std::min(places_of(tables, s) * int64_t(times), int64_t(1) << 16);
  int walks = std::min(walks_of(tables, s) * int64_t(times), int64_t(1) << 16);
  draw_candidates(transport, settings.max_depth - 2, places, walks, seed, index, pool);
  uint32_t number = uint32_t(pool.lights.size()), bounced = 0;
  while (bounced < number && pool.lights[bounced].depth == 0) bounced++;

  ViewProbes probes = probe_view(transport, view, settings.max_depth, probe_count,
                                 mix64(seed ^ probe_stream), index);
  Sampler sampler(mix64(seed ^ choice_stream), index);
  DrawnSet exact;
  add_exact(tables, exact);
  std::vector<std::vector<KeptPointLight>> kept(size_t(pass.sets()));
  auto keep = [&](uint32_t begin, uint32_t end, int wanted) {
    float choose_u = sampler.next(), deal_u = sampler.next();
    for (const ChosenLight& c :
         choose_lights(transport, probes, pool, begin, end, settings.max_depth,
                       wanted * pass.sets(), pass.sets(), choose_u, deal_u))
      kept[c.set].push_back({c.light, c.factor});
  };
  keep(0, bounced, std::clamp(s.places, 0, 1 << 16));
  keep(bounced, number, std::clamp(s.bounced, 0, 1 << 16));
  if (pass.sharp)
    draw_photons(transport, settings, photon_radius(s, size, index), seed, index, pass);
  join_kept(tables, pool, exact, kept, pass);
  choose_region_lights(transport, view, settings.max_depth, std::min(s.asked, 1 << 10),
                       mix64(seed ^ region_stream), index, pass);
  return pass;
}

}  // namespace wellspring::light
