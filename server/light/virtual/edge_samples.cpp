// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/edge_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "light/virtual/caustic_photons.h"
#include "light/virtual/eye_light.h"
#include "light/sample/sample_light.h"
#include "light/walk/first_surface.h"
#include "light/walk/trace_lambert.h"

namespace wellspring::light {
namespace {

// Holds what the additional samples of a pixel have found.
struct Refined {
  size_t pixel = 0;
  int lit = 0;       // samples besides the pixel's own
  vec3 radiance{0};  // sum over these samples
};

struct Refining {
  const World& world;
  const Lights& lights;
  const TransportSettings& settings;
  const View& view;
  const DiscontinuitySettings& continuity;
  int rays;
  uint64_t seed;
  uint32_t index;
  std::span<const uint8_t> edges;
  std::span<const Sample> samples;
  float pixel_angle;
};

// Returns the pixel nearest to (x, y) in the picture that shows the surface of `sample`; null:
// none.
const Sample* find_same(const Refining& r, const Sample& sample, float x, float y) {
  const Sample* best = nullptr;
  float nearest = std::numeric_limits<float>::infinity();
  int column = int(x), row = int(y);
  for (int v = std::max(row - 1, 0); v <= std::min(row + 1, r.view.height - 1); v++)
    for (int u = std::max(column - 1, 0); u <= std::min(column + 1, r.view.width - 1); u++) {
      float dx = float(u) + 0.5f - x, dy = float(v) + 0.5f - y, away = dx * dx + dy * dy;
      const Sample& other = r.samples[size_t(v) * size_t(r.view.width) + size_t(u)];
      if (away >= nearest || !(other.flags & sample_hit)) continue;
      if (!is_continuous(sample, other, r.continuity, r.pixel_angle)) continue;
      nearest = away;
      best = &other;
    }
  return best;
}

// Takes the light of a neighbour that shows the same surface; returns false if none does.
bool take_light(const Refining& r, const Sample& sample, vec2 place, vec3& radiance) {
  const Sample* same = find_same(r, sample, place.x, place.y);
  if (same) radiance = sample.albedo * same->smooth + same->rest;
  return same;
}

// Finds the ray's radiance from its neighbours; returns false if they do not suffice.
bool eval_alike(const Refining& r, const Request& request, vec2 place, vec3& radiance) {
  Transport transport{r.world, *r.lights.tables};
  Sampler sampler(request.seed, request.index);
  Sample sample;
  FirstSurface first =
      find_first_surface(transport, r.settings.max_depth, request, sampler, sample);
  if (!first.scatters && !first.mirrored) {
    radiance = sample.rest;
    return true;
  }
  if (!first.scatters || max_component(sample.rest) > 0) return false;
  sample.albedo = demodulated_reflectance(first).albedo * first.tint;
  return take_light(r, sample, place, radiance);
}

// Holds the rays that a row's edges need, and their places in the picture.
struct Looks {
  std::vector<Request> requests;
  std::vector<vec2> places;
  std::vector<size_t> pixels;  // index in the row's list, for each ray
};

Looks look_at_edges(const Refining& r, int y, std::vector<Refined>& refined) {
  Looks looks;
  for (int x = 0; x < r.view.width; x++) {
    Refined pixel;
    pixel.pixel = size_t(y) * size_t(r.view.width) + size_t(x);
    if (!r.edges[pixel.pixel]) continue;
    pixel.lit = r.rays;
    uint64_t seed = mix64(r.seed + pixel.pixel);
    for (int i = 0; i < r.rays; i++) {
      Request request;
      request.pixel = uint32_t(pixel.pixel);
      request.seed = seed;
      request.index = r.index * uint32_t(r.rays) + uint32_t(i);
      Sampler jitter(mix64(seed ^ 0x6a09e667f3bcc909ull), request.index);
      vec2 place = vec2(float(x), float(y)) + jitter.next2();
      request.ray = view_ray(r.view, place.x, place.y);
      looks.requests.push_back(request);
      looks.places.push_back(place);
      looks.pixels.push_back(refined.size());
    }
    refined.push_back(pixel);
  }
  return looks;
}

void refine_row(const Refining& r, int y, std::vector<Refined>& refined) {
  Looks looks = look_at_edges(r, y, refined);
  std::vector<uint32_t> unknown;
  std::vector<Sample> samples(looks.requests.size());
  LambertHits seen = see_lambert({r.world, *r.lights.tables}, looks.requests, samples);
  vec3 radiance;
  auto answer = [&](uint32_t i, bool known) {
    if (known) refined[looks.pixels[i]].radiance += radiance;
    else unknown.push_back(i);
  };
  for (uint32_t i : seen.nothing) refined[looks.pixels[i]].radiance += samples[i].rest;
  for (const LambertHit& eye : seen.eyes)
    answer(eye.request, take_light(r, samples[eye.request], looks.places[eye.request], radiance));
  for (uint32_t i : seen.others)
    answer(i, eval_alike(r, looks.requests[i], looks.places[i], radiance));
  std::vector<Request> asked;
  for (uint32_t i : unknown) asked.push_back(looks.requests[i]);
  samples.resize(asked.size());
  trace_many_instant(r.world, r.lights, r.settings, asked, samples);
  for (size_t i = 0; i < asked.size(); i++)
    refined[looks.pixels[unknown[i]]].radiance += samples[i].radiance();
}

}  // namespace

void refine_edges(const World& world, const Lights& lights, const TransportSettings& settings,
                  const View& view, const DiscontinuitySettings& continuity, int rays,
                  uint64_t seed, uint32_t index, std::span<const uint8_t> edges,
                  std::span<Sample> samples) {
  if (rays < 1 || settings.max_depth < 1) return;
  Refining refining{world,
                    lights,
                    settings,
                    view,
                    continuity,
                    rays,
                    seed,
                    index,
                    edges,
                    samples,
                    2 * view.tan_half_fov / float(view.height)};
  std::vector<std::vector<Refined>> rows(size_t(view.height));
  parallel_each(view.height, [&](int y) { refine_row(refining, y, rows[size_t(y)]); });
  parallel_for(view.height, [&](int y) {
    for (const Refined& pixel : rows[size_t(y)]) {
      Sample& sample = samples[pixel.pixel];
      float own = 1 / float(1 + pixel.lit);
      sample.albedo *= own;
      sample.rest = own * (sample.rest + pixel.radiance);
      sample.glow *= own;
      sample = finish_sample(lights, settings, sample);
    }
  });
}

namespace {

// Holds one request on its way.
struct Eye {
  Sampler sampler;
  Sample sample;
  FirstSurface first;
  std::unique_ptr<std::optional<WavelengthSpread>> spread;  // if the surface parts colours
  PixelGroup group;
  DemodulatedReflectance kept;  // without the tint
  PlaceLight light;
};

// Gives the surface a reflectance of 1, so that light is kept apart from what reflects it.
void split_first(Eye& eye) {
  Bsdf& bsdf = eye.first.bsdf;
  eye.kept = demodulated_reflectance(eye.first);
  vec3 a = eye.kept.albedo;
  bool soft = !has_sharp(bsdf, mirror_alpha) && !(max_component(bsdf.transmit) > 0) &&
              std::min({a.x, a.y, a.z}) >= least_demodulated_metal;
  eye.kept.lit_gloss = soft ? 1 : 0;
  eye.sample.albedo = a * eye.first.tint;
  bsdf.diffuse = eye.kept.diffuse ? vec3(1) : vec3(0);
  if (bsdf.alpha < 0.1f && bsdf.diffuse_share < 0.5f) eye.sample.flags |= sample_specular;
}

// Follows the components of the first scattering, each on its own (section 4: the eye's path is
// split once).
void follow_first(const EyeLight& light, Eye& eye) {
  const Transport& transport = light.transport;
  const FirstSurface& first = eye.first;
  const Bsdf& bsdf = first.bsdf;
  if (!has_sharp(bsdf, mirror_alpha)) return;
  vec3 rest(0);
  if (has_blurred(bsdf))
    rest +=
        sample_direct_light(transport, first.walk, first.surface, bsdf, true, eye.sampler).specular;
  // A faint gloss over a diffuse layer is followed now and then, a strong one each time.
  float chance = has_diffuse(bsdf) ? glm::clamp(4 * (1 - bsdf.diffuse_share), 0.25f, 1.0f) : 1.0f;
  if (chance == 1 || eye.sampler.next() < chance) {
    Walk next = first.walk;
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::specular, eye.sampler);
    if (eye.spread)
      carry_wavelengths(**eye.spread, bsdf, Lobes::specular, scattered, next.wavelengths);
    scattered.weight /= chance;
    next.area_share = scattered.pdf > 0 && transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (scattered.bounce == Bounce::refract) next.density *= bsdf.eta * bsdf.eta;
    if (advance(next, first.surface, scattered)) rest += follow_mirrors(light, next, eye.sampler);
  }
  eye.sample.rest += first.tint * rest;
}

void finish(const EyeLight& light, Eye& eye) {
  if (eye.first.scatters) {
    LitPlace place{&eye.first.surface, &eye.first.bsdf, &eye.first.walk.media, eye.first.walk.depth,
                   mirror_alpha};
    gather_rest(light, place, eye.sampler, eye.light);
    Sample& sample = eye.sample;
    const PlaceLight& got = eye.light;
    const DemodulatedReflectance& kept = eye.kept;
    vec3 albedo = kept.diffuse ? sample.albedo * kept.diffuse_share : vec3(0);
    sample.smooth += kept.diffuse_share * got.diffuse;
    sample.rest += albedo * got.exact_diffuse;
    if (kept.lit_gloss > 0) sample.smooth += got.specular / kept.albedo;
    else sample.rest += eye.first.tint * got.specular;
    sample.rest += eye.first.tint * got.exact_specular;
    follow_first(light, eye);
  }
  if (eye.first.mirrored)
    eye.sample.rest += follow_mirrors(light, eye.first.reflection, eye.sampler);
}

// Answers the requests of those numbers, whatever material they see.
void trace_others(const Transport& transport, const InstantPass& pass, int max_depth,
                  std::span<const Request> requests, std::span<const uint32_t> numbers,
                  std::span<Sample> samples) {
  std::vector<Eye> eyes;
  eyes.reserve(numbers.size());
  GroupOrder order;
  for (size_t i = 0; i < numbers.size(); i++) {
    const Request& request = requests[numbers[i]];
    Eye& eye = eyes.emplace_back(Eye{Sampler(request.seed, request.index), {}, {}, {}, {}, {}, {}});
    eye.group = group_of_pixel(pass, request.pixel);
    if (max_depth < 1) continue;
    eye.first = find_first_surface(transport, max_depth, request, eye.sampler, eye.sample);
    if (!eye.first.scatters) continue;
    if (parts_colors(transport, eye.first.walk.media, eye.first.surface)) {
      eye.spread = std::make_unique<std::optional<WavelengthSpread>>();
      part_seen_colors(transport, eye.first.walk, eye.first.surface, eye.sampler, eye.first.bsdf,
                       *eye.spread);
    }
    split_first(eye);
    order.add(eye.group, uint32_t(i));
  }
  order.sort();
  for (size_t begin = 0; begin < order.size();) {
    LitPlace places[RayPacket::lanes];
    PlaceLight light[RayPacket::lanes];
    uint32_t items[RayPacket::lanes];
    PixelGroup group;
    int count = int(order.take(begin, RayPacket::lanes, items, group));
    begin += size_t(count);
    for (int i = 0; i < count; i++) {
      const Eye& eye = eyes[items[i]];
      places[i] = {&eye.first.surface, &eye.first.bsdf, &eye.first.walk.media, eye.first.walk.depth,
                   mirror_alpha};
    }
    int set = set_of_list(pass, group.list);
    shade_by_point_lights(transport, pass, {set, 0, 1, 0, group.region, group.list}, max_depth,
                          places, count, light);
    if (!pass.photons.empty()) {
      PhotonCells cells;
      for (int i = 0; i < count; i++)
        shade_by_photons(pass.photons[size_t(set)], max_depth, places[i], cells, light[i]);
    }
    for (int i = 0; i < count; i++) eyes[items[i]].light = light[i];
  }
  for (size_t i = 0; i < eyes.size(); i++) {
    if (max_depth >= 1)
      finish({transport, pass, max_depth, set_of_list(pass, eyes[i].group.list)}, eyes[i]);
    samples[numbers[i]] = eyes[i].sample;
  }
}

}  // namespace

void trace_many_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                        std::span<const Request> requests, std::span<Sample> samples) {
  static const InstantPass nothing = [] {
    InstantPass pass;
    pass.first = {0, 0};
    return pass;
  }();
  const InstantPass& pass = lights.pass ? *lights.pass : nothing;
  Transport transport{world, *lights.tables};
  std::vector<uint32_t> others;
  if (pass.sharp || settings.max_depth < 2) {
    for (size_t i = 0; i < requests.size(); i++) others.push_back(uint32_t(i));
  } else {
    others = trace_lambert_hits(transport, pass, settings.max_depth, requests, samples);
  }
  trace_others(transport, pass, settings.max_depth, requests, others, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                     const Request& request) {
  Sample sample;
  trace_many_instant(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

}  // namespace wellspring::light
