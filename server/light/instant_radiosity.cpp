// SPDX-License-Identifier: Apache-2.0
#include "light/instant_radiosity.h"

#include <algorithm>

#include "light/caustic_photons.h"
#include "light/discontinuity_buffer.h"
#include "light/edge_samples.h"
#include "light/eye_light.h"
#include "light/first_surface.h"
#include "light/split_reflectance.h"
#include "light/technique_list.h"

namespace wellspring {
namespace {

constexpr int pixels_a_candidate = 2048;

// One request on its way.
struct Eye {
  Sampler sampler;
  Sample sample;
  FirstSurface first;
  std::unique_ptr<std::optional<WavelengthSpread>> spread;  // of its colours, if it parts them
  int set = 0, region = -1;
  bool soft = false;    // rough gloss is filtered with the diffuse light
  vec3 reflectance{0};  // sample.albedo without the tint
  PlaceLight light;
};

// Of reflectance 1, so that light is kept apart from what reflects it.
void split_first(Eye& eye) {
  Bsdf& bsdf = eye.first.bsdf;
  SplitReflectance split = split_reflectance(bsdf);
  eye.soft = split.soft;
  eye.reflectance = split.albedo;
  eye.sample.albedo = split.albedo * eye.first.tint;
  bsdf.diffuse = max_component(bsdf.diffuse) > 1e-4f ? vec3(1) : vec3(0);
  if (bsdf.alpha < 0.1f && bsdf.diffuse_share < 0.5f) eye.sample.flags |= sample_specular;
}

// The components of the first scattering, each on its own (section 4: the eye's path is split once).
void follow_first(const EyeLight& light, Eye& eye) {
  const Transport& transport = light.transport;
  const FirstSurface& first = eye.first;
  const Bsdf& bsdf = first.bsdf;
  if (!has_sharp(bsdf, mirror_alpha)) return;
  vec3 rest(0);
  if (has_blurred(bsdf))
    rest += sample_direct_light(transport, first.walk, first.surface, bsdf, true, eye.sampler)
                .specular;
  // A faint gloss over a diffuse layer is followed now and then, a strong one each time.
  float chance =
      has_diffuse(bsdf) ? glm::clamp(4 * (1 - bsdf.diffuse_share), 0.25f, 1.0f) : 1.0f;
  if (chance == 1 || eye.sampler.next() < chance) {
    Walk next = first.walk;
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::specular, eye.sampler);
    if (eye.spread)
      carry_wavelengths(**eye.spread, bsdf, Lobes::specular, scattered, next.wavelengths);
    scattered.weight /= chance;
    next.area_share = scattered.pdf > 0 && transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (advance(next, first.surface, scattered))
      rest += follow_mirrors(light, next, eye.sampler);
  }
  eye.sample.rest += first.tint * rest;
}

void finish(const EyeLight& light, Eye& eye) {
  if (eye.first.scatters) {
    LitPlace place{&eye.first.surface, &eye.first.bsdf, &eye.first.walk.media,
                   eye.first.walk.depth, mirror_alpha};
    gather_rest(light, place, eye.sampler, eye.light);
    Sample& sample = eye.sample;
    const PlaceLight& got = eye.light;
    vec3 albedo = has_diffuse(eye.first.bsdf) ? sample.albedo : vec3(0);
    sample.smooth += got.diffuse;
    sample.rest += albedo * got.exact_diffuse;
    if (eye.soft) sample.smooth += got.specular / eye.reflectance;
    else sample.rest += eye.first.tint * got.specular;
    sample.rest += eye.first.tint * got.exact_specular;
    follow_first(light, eye);
  }
  if (eye.first.mirrored)
    eye.sample.rest += follow_mirrors(light, eye.first.reflection, eye.sampler);
}

}  // namespace

void trace_many_instant(const World& world, const Lights& lights,
                        const TransportSettings& settings, std::span<const Request> requests,
                        std::span<Sample> samples) {
  static const InstantPass nothing = [] {
    InstantPass pass;
    pass.first = {0, 0};
    return pass;
  }();
  const InstantPass& pass = lights.pass ? *lights.pass : nothing;
  Transport transport{world, *lights.tables};
  std::vector<Eye> eyes;
  eyes.reserve(requests.size());
  std::vector<uint32_t> order;
  for (size_t i = 0; i < requests.size(); i++) {
    const Request& request = requests[i];
    Eye& eye = eyes.emplace_back(Eye{Sampler(request.seed, request.index), {}, {}, {}, 0, -1, false, {}, {}});
    eye.set = set_of_pixel(pass, request.pixel);
    eye.region = region_of_pixel(pass, request.pixel);
    if (settings.max_depth < 1) continue;
    eye.first =
        find_first_surface(transport, settings.max_depth, request, eye.sampler, eye.sample);
    if (!eye.first.scatters) continue;
    if (parts_colors(transport, eye.first.walk.media, eye.first.surface)) {
      eye.spread = std::make_unique<std::optional<WavelengthSpread>>();
      part_seen_colors(transport, eye.first.walk, eye.first.surface, eye.sampler, eye.first.bsdf,
                       *eye.spread);
    }
    split_first(eye);
    order.push_back(uint32_t(i));
  }
  // Pixels of one region and set side by side, as near to each other as they were asked for.
  auto key = [&](uint32_t i) { return std::pair(eyes[i].region, eyes[i].set); };
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  for (size_t begin = 0; begin < order.size();) {
    LitPlace places[RayPacket::lanes];
    PlaceLight light[RayPacket::lanes];
    auto [region, set] = key(order[begin]);
    int count = 0;
    for (; count < RayPacket::lanes && begin + size_t(count) < order.size(); count++) {
      const Eye& eye = eyes[order[begin + size_t(count)]];
      if (eye.set != set || eye.region != region) break;
      places[count] = {&eye.first.surface, &eye.first.bsdf, &eye.first.walk.media,
                       eye.first.walk.depth, mirror_alpha};
    }
    shade_by_point_lights(transport, pass, {set, 0, 1, 0, region}, settings.max_depth, places, count,
                          light);
    if (!pass.photons.empty()) {
      PhotonCells cells;
      for (int i = 0; i < count; i++)
        shade_by_photons(pass.photons[size_t(set)], settings.max_depth, places[i], cells, light[i]);
    }
    for (int i = 0; i < count; i++) eyes[order[begin + size_t(i)]].light = light[i];
    begin += size_t(count);
  }
  for (size_t i = 0; i < eyes.size(); i++) {
    Eye& eye = eyes[i];
    if (settings.max_depth >= 1)
      finish({transport, pass, settings.max_depth, eye.set}, eye);
    samples[i] = finish_sample(lights, settings, eye.sample);
  }
}

Sample trace_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                     const Request& request) {
  Sample sample;
  trace_many_instant(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

void begin_instant(const World& world, const TransportSettings& settings, const View& view,
                   uint64_t seed, uint32_t index, Lights& lights) {
  // A small picture has no use for more photons than pixels, and choosing must cost less than it saves.
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
  filter_smooth(view, settings, samples);
  refine_edges(world, lights, pass.settings, view, settings, pass.settings.instant.edge_rays,
               mix64(pass.seed ^ 0x6564676573ull), pass.index, samples);
}

}  // namespace wellspring
