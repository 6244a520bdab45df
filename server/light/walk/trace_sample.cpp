// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "light/walk/first_surface.h"
#include "light/walk/known_light.h"

namespace wellspring::light {
namespace {

// Mirrors, glass and polished metal: what is seen there moves with the view.
bool looks_specular(const Bsdf& bsdf) { return bsdf.alpha < 0.1f && bsdf.diffuse_share < 0.5f; }

// The first surface's light, its diffuse lobe (of reflectance 1) and its specular lobes sampled
// apart.
void shade_first(const Transport& transport, const WalkRules& rules, FirstSurface& first,
                 Sampler& sampler, Sample& sample) {
  const Walk& walk = first.walk;
  const Surface& surface = first.surface;
  const vec3 tint = first.tint;
  Bsdf& bsdf = first.bsdf;
  const uint32_t base = Dimensions::first_surface;
  std::optional<WavelengthSpread> spread;
  part_colors(transport, walk, surface, base, sampler, bsdf, spread);
  DemodulatedReflectance kept = demodulated_reflectance(first);
  bool diffuse = kept.diffuse;
  KnownLight known;
  if (diffuse && first.metal == MetalDemodulation::none && walk.media.here.count == 0)
    known = find_known_light(transport, walk.ray, first.hit, surface);
  const bool read = known.known && rules.reads_maps && !may_be_shaded(transport, surface.position);
  vec3 albedo = kept.albedo, diffuse_albedo = kept.diffuse ? bsdf.diffuse : vec3(0);
  auto add_gloss = [&](vec3 light, float filtered) {
    if (filtered > 0) sample.smooth += filtered * light / albedo;
    if (filtered < 1) sample.rest += (1 - filtered) * tint * light;
  };
  bsdf.diffuse = diffuse ? vec3(1) : vec3(0);
  sample.albedo = albedo * tint;
  if (looks_specular(bsdf)) sample.flags |= sample_specular;
  if (has_specular(bsdf)) sample.flags &= uint8_t(~sample_sure);
  sampler.seek(base);
  if (!is_smooth(bsdf)) {
    DirectLight direct = sample_direct_light(transport, walk, surface, bsdf, true, sampler);
    if (known.known) direct.area_diffuse += direct.punctual_diffuse;
    if (!read) sample.smooth += walk.throughput * kept.diffuse_share * direct.area_diffuse;
    if (!known.known)
      sample.rest += tint * walk.throughput * diffuse_albedo * direct.punctual_diffuse;
    add_gloss(walk.throughput * direct.specular, kept.lit_gloss);
    if (!direct.sure_of_punctual()) sample.flags &= uint8_t(~sample_sure);
  }
  if (read) {
    sample.smooth += known.light * (bsdf.coat_passes * bsdf.beneath);
  } else if (diffuse) {
    Walk next = walk;
    next.area_share = transport.tables.area_share > 0 ? 1.0f : 0.0f;
    sampler.seek(base + Dimensions::scatter);
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::diffuse, sampler);
    if (advance(next, surface, scattered)) {
      next.from_normal = lit_side(surface, bsdf);
      sampler.seek(Dimensions::walk);
      sample.smooth += kept.diffuse_share * follow(transport, rules, next, sampler);
    }
  }
  // A faint gloss over a diffuse layer is followed now and then, a strong one each time.
  float chance = diffuse ? glm::clamp(4 * (1 - bsdf.diffuse_share), 0.25f, 1.0f) : 1.0f;
  sampler.seek(base + Dimensions::survival);
  if (has_specular(bsdf) && (chance == 1 || sampler.next() < chance)) {
    Walk next = walk;
    sampler.seek(base + Dimensions::specular);
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::specular, sampler);
    if (spread) carry_wavelengths(*spread, bsdf, Lobes::specular, scattered, next.wavelengths);
    scattered.weight /= chance;
    next.area_share = scattered.pdf > 0 && transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (scattered.bounce == Bounce::refract) next.density *= bsdf.eta * bsdf.eta;
    if (advance(next, surface, scattered)) {
      if (scattered.bounce != Bounce::pass) next.from_normal = lit_side(surface, bsdf);
      sampler.seek(2 * Dimensions::walk);
      add_gloss(follow(transport, rules, next, sampler), kept.other_gloss);
    }
  }
  if (known.known) tell_in_units(known, sample.smooth, sample);
}

// The same where that surface is Lambertian: one lobe and no gloss.
void shade_first_lambert(const Transport& transport, const WalkRules& rules, Walk& walk,
                         const Hit& hit, Sampler& sampler, Sample& sample) {
  LambertSurface surface = eval_lambert_surface(transport.world, walk.ray, hit);
  describe_place(transport.world, hit, surface, surface.normal, hit.t, sample);
  sample.flags |= sample_sure;
  if (rules.max_depth < 2) return;
  LambertLobe lobe = make_lambert(surface, walk.ray.direction);
  if (!(max_component(lobe.reflectance) > least_albedo)) return;
  sample.albedo = lobe.reflectance * eval_absorption(transport, walk.media.here.innermost(), hit.t);
  KnownLight known;
  if (walk.media.here.count == 0)
    known = find_known_light(transport, walk.ray, hit, surface.position);
  if (known.known && rules.reads_maps && !may_be_shaded(transport, surface.position))
    return tell_in_units(known, known.light, sample);
  const uint32_t base = Dimensions::first_surface;
  sampler.seek(base);
  DirectLight direct = sample_direct_light(transport, walk, surface, lobe, true, sampler);
  sample.smooth += direct.area_diffuse;
  if (known.known) sample.smooth += direct.punctual_diffuse;
  else sample.rest += sample.albedo * direct.punctual_diffuse;
  if (!direct.sure_of_punctual()) sample.flags &= uint8_t(~sample_sure);
  sampler.seek(base + Dimensions::scatter + 1);
  BsdfSample scattered = sample_lambert(lobe, sampler.next2());
  if (scattered.pdf > 0) scattered.weight = vec3(1);
  if (advance(walk, surface, scattered)) {
    walk.area_share = transport.tables.area_share > 0 ? 1.0f : 0.0f;
    sampler.seek(Dimensions::walk);
    sample.smooth += follow(transport, rules, walk, sampler);
  }
  if (known.known) tell_in_units(known, sample.smooth, sample);
}

}  // namespace

Sample trace_sample(const Transport& transport, const WalkRules& rules, const Request& request) {
  if (rules.max_depth < 1) return {};
  return trace_sample(transport, rules, request, transport.world.intersect(request.ray));
}

Sample trace_sample(const Transport& transport, const WalkRules& rules, const Request& request,
                    const Hit& hit) {
  Sampler sampler(request.seed, request.index);
  Sample sample;
  Walk walk = begin_walk(transport, request);
  if (!hit.valid()) {
    describe_sky(transport, walk.ray.direction, vec3(1), sample);
    sample.flags |= sample_sure;
    return sample;
  }
  if (met_lambertian(transport, hit)) {
    shade_first_lambert(transport, rules, walk, hit, sampler, sample);
    return sample;
  }
  FirstSurface first = find_first_surface(transport, rules.max_depth, walk, hit, sampler, sample);
  sample.flags |= sample_sure;  // until chance comes in
  if (first.scatters) shade_first(transport, rules, first, sampler, sample);
  if (first.mirrored) {
    sample.flags &= uint8_t(~sample_sure);
    sampler.seek(3 * Dimensions::walk);
    sample.rest += follow(transport, rules, first.reflection, sampler);
  }
  return sample;
}

}  // namespace wellspring::light
