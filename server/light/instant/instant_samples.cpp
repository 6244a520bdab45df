// SPDX-License-Identifier: Apache-2.0
#include "light/instant/instant_samples.h"

#include <algorithm>

#include "light/instant/caustic_photons.h"
#include "light/instant/eye_light.h"
#include "light/instant/instant_lambert.h"
#include "light/sample/finish_samples.h"
#include "light/walk/first_surface.h"

namespace wellspring::light {
namespace {

// One request on its way.
struct Eye {
  Sampler sampler;
  Sample sample;
  FirstSurface first;
  std::unique_ptr<std::optional<WavelengthSpread>> spread;  // of its colours, if it parts them
  PixelGroup group;
  DemodulatedReflectance kept;  // without the tint
  PlaceLight light;
};

// Of reflectance 1, so that light is kept apart from what reflects it.
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

// The components of the first scattering, each on its own (section 4: the eye's path is split
// once).
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

// Of whatever material.
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
