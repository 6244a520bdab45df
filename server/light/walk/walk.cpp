// SPDX-License-Identifier: Apache-2.0
#include "light/walk/walk.h"

#include <algorithm>
#include <cmath>

#include "light/material/bsdf_gloss.h"
#include "light/material/bsdf_types.h"
#include "light/random/warp.h"
#include "light/walk/known_light.h"

namespace wellspring::light {

bool parts_colors(const Transport& transport, const Media& media, const Surface& surface) {
  if (!transport.tables.plan.uses(TransportPart::dispersion)) return false;
  const Material& material = transport.world.scene().materials[size_t(surface.material)];
  return is_dispersive(surface, material) && owns_boundary(media, surface);
}

namespace {

float draw_hero(Sampler& sampler) {
  const float u = sampler.next();
  const uint64_t sample = uint64_t(sampler.reversed_index) << 32 | sampler.drawn;
  return hero_place(u, mix64(sampler.seed ^ mix64(sample)));
}

}  // namespace

void part_colors(const Transport& transport, const Media& media, vec3 direction,
                 const Surface& surface, const Wavelengths& carried, Sampler& sampler, Bsdf& bsdf,
                 std::optional<WavelengthSpread>& spread) {
  const Material& material = transport.world.scene().materials[size_t(surface.material)];
  float outside = index_outside(transport, media, surface);
  const DielectricAlbedo& albedo =
      outside == 1 ? *transport.tables.materials[size_t(surface.material)].albedo
                   : dielectric_albedo(std::max(material.ior / outside, outside / material.ior));
  const float place = carried.carried == 0 ? draw_hero(sampler) : 0;
  spread_wavelengths(*transport.tables.spectral, surface, material, direction, albedo, carried,
                     place, bsdf, spread, outside);
}

namespace {

constexpr float wide = 1;  // density of a ray; shadows of what moves are lost among rays of less
constexpr int mirrored_depth = 12;  // edges of perfect mirrors and glass that are never cut short

// Plays Russian roulette: survivors carry the share of those that stop. Returns false if this one
// stops.
bool survives(Walk& walk, Sampler& sampler) {
  if (!(max_component(walk.throughput) > 0)) return false;
  if (walk.edges() <= (walk.pdf > 0 ? roulette_depth : mirrored_depth)) return true;
  // In clear glass a walk that is bright enough always survives.
  const bool clear = walk.pdf <= 0 && walk.glass > 0 && walk.glass <= sure_glass;
  float chance =
      std::min(clear ? 1.0f : glass_survival, max_component(walk.throughput) * walk.density);
  if (sampler.next() >= chance) return false;
  walk.throughput /= chance;
  return true;
}

}  // namespace

bool ends_in_volume(const Transport& transport, const Walk& walk, float t_end, vec3& radiance) {
  const bool sharp = walk.scattered == 0 || (walk.scattered == 1 && walk.pdf > wide);
  const std::optional<VolumeHit> met = transport.world.meet_volume(walk.ray, t_end, sharp);
  const vec3 throughput = walk.throughput * walk_tint(transport, walk);
  radiance += throughput * transport.world.volume_glow(walk.ray, met ? met->t : t_end);
  if (!met) return false;
  radiance +=
      throughput * eval_absorption(transport, walk.media.here.innermost(), met->t) * met->color;
  return true;
}

vec3 walk_met_emission(const Transport& transport, const Walk& walk, const Surface& surface,
                       const Material& material) {
  vec3 emission =
      surface_emission(surface, material) * walk_tint(transport, walk, material.spectra.emission);
  if (walk.pdf <= 0 || walk.area_share <= 0 || emission == vec3(0)) return emission;
  float other = walk.area_share * sample_emitter_pdf(transport.tables, walk.from, walk.from_normal,
                                                     walk.ray.direction, surface);
  return emission * mis_weight(walk.pdf, other);
}

vec3 walk_met_sky(const Transport& transport, const Walk& walk) {
  vec3 radiance = eval_environment(transport.tables.environment, walk.ray.direction) *
                  walk_tint(transport, walk);
  if (walk.pdf <= 0 || walk.area_share <= 0 || radiance == vec3(0)) return radiance;
  float other = walk.area_share * sample_sky_pdf(transport.tables, walk.ray.direction);
  return radiance * mis_weight(walk.pdf, other);
}

vec3 eval_tint(const Transport& transport, int medium, float length) {
  if (!std::isfinite(length)) return vec3(1);
  const Material& m = transport.world.scene().materials[size_t(medium)];
  if (!std::isfinite(m.attenuation_distance) || !(m.attenuation_distance > 0)) return vec3(1);
  float lengths = length / m.attenuation_distance;
  vec3 c = glm::clamp(m.attenuation_color, vec3(0), vec3(1));
  return {std::pow(c.x, lengths), std::pow(c.y, lengths), std::pow(c.z, lengths)};
}

void part_colors(const Transport& transport, const Walk& walk, const Surface& surface,
                 uint32_t dimensions, Sampler& sampler, Bsdf& bsdf,
                 std::optional<WavelengthSpread>& spread) {
  if (!parts_colors(transport, walk.media, surface)) return;
  sampler.seek(dimensions + Dimensions::wavelength);
  part_colors(transport, walk.media, walk.ray.direction, surface, walk.wavelengths, sampler, bsdf,
              spread);
}

void absorb(const Transport& transport, Walk& walk, float length, uint32_t dimensions,
            Sampler& sampler) {
  const int medium = walk.media.here.innermost();
  const vec3 tint = eval_absorption(transport, medium, length);
  const bool colored = tint == vec3(1) || !transport.tables.spectral || walk.wavelengths.tinted;
  const int row =
      colored ? -1 : transport.world.scene().materials[size_t(medium)].spectra.absorption;
  if (row < 0) {
    walk.throughput *= tint;
    return;
  }
  const vec3 left = max(tint, vec3(1e-6f));
  walk.throughput *= left;
  const SpectralTables& tables = *transport.tables.spectral;
  sampler.seek(dimensions + Dimensions::absorbed);
  if (walk.wavelengths.carried == 0) begin_cluster(tables, draw_hero(sampler), walk.wavelengths);
  absorb_wavelengths(tables, row, length, left, walk.wavelengths);
}

namespace {

void reflect(const Transport& transport, int reflectance, uint32_t dimensions, Sampler& sampler,
             Wavelengths& carried) {
  const SpectralTables& tables = *transport.tables.spectral;
  sampler.seek(dimensions + Dimensions::wavelength);
  if (carried.carried == 0 && carried.reflected >= 0)
    begin_cluster(tables, draw_hero(sampler), carried);
  reflect_wavelengths(tables, reflectance, carried);
}

}  // namespace

void reflect(const Transport& transport, const Hit& hit, uint32_t dimensions, Sampler& sampler,
             Wavelengths& carried) {
  if (!transport.tables.spectral || carried.tinted) return;
  const int reflectance = transport.world.material_of(hit.instance).spectra.reflectance;
  if (reflectance >= 0) reflect(transport, reflectance, dimensions, sampler, carried);
}

void reflect(const Transport& transport, const Material& material, const Bsdf& bsdf, Lobes lobes,
             uint32_t dimensions, Sampler& sampler, BsdfSample& scattered, Wavelengths& carried) {
  if (material.spectra.reflectance < 0 || carried.tinted || !transport.tables.spectral) return;
  bool tinted =
      tints_gloss(material) || lobes == Lobes::diffuse || scattered.bounce != Bounce::reflect;
  if (!tinted && lobes == Lobes::all && scattered.pdf > 0) {
    const BsdfValue value = eval_bsdf(bsdf, scattered.direction);
    const float diffuse = luminance(value.diffuse), specular = luminance(value.specular);
    if (!(diffuse + specular > 0)) return;
    sampler.seek(dimensions + Dimensions::lobe);
    const float chance = diffuse / (diffuse + specular);
    tinted = sampler.next() < chance;
    scattered.weight = tinted ? value.diffuse / (scattered.pdf * chance)
                              : value.specular / (scattered.pdf * (1 - chance));
  }
  if (tinted) reflect(transport, material.spectra.reflectance, dimensions, sampler, carried);
}

bool advance(Walk& walk, const SurfacePlace& place, const BsdfSample& scattered) {
  if (!(max_component(scattered.weight) > 0)) return false;
  walk.throughput *= scattered.weight;
  if (walk.ray.spread > 0) {
    // A picture in a mirror is seen as sharp as one behind a pane.
    if (scattered.pdf > 0) walk.ray.spread = walk.ray.width = 0;
    else walk.ray.width += walk.ray.spread * distance(place.position, walk.ray.origin);
  }
  walk.ray.direction = scattered.direction;
  walk.ray.origin = offset_origin(place, scattered.direction);
  if (scattered.bounce == Bounce::pass) return ++walk.panes <= most_panes;
  walk.ray.from_eye = false;
  walk.panes = 0;
  if (!scattered.glass) walk.depth++;
  else if (++walk.glass > most_glass) return false;
  walk.pdf = scattered.pdf;
  walk.from = place.position;
  walk.from_normal = place.geometric_normal;
  walk.scattered += scattered.pdf > 0;
  if (scattered.bounce == Bounce::refract) walk.media.here = walk.media.beyond;
  return true;
}

namespace {

// Say how a surface scatters, for light sampling: the value towards a direction, and the density
// with which sampling all of its lobes draws that direction.
constexpr float blunt_alpha = 0.6f;  // rougher gloss is spread as Lambertian light is
struct ByBsdf {
  const Bsdf& bsdf;
  BsdfValue eval(vec3 direction) const { return eval_bsdf(bsdf, direction); }
  float pdf(const BsdfValue& value) const { return sample_bsdf_pdf(bsdf, value, Lobes::all); }
  LobeHint hint() const {
    LobeHint lobe;
    if (max_component(bsdf.transmit) > 0) return lobe;  // has a sharp lobe on either side
    lobe.diffuse = luminance(bsdf.diffuse);
    if (bsdf.alpha > 0 && bsdf.alpha < blunt_alpha) {
      lobe.specular = eval_gloss_strength(bsdf);
      lobe.alpha = bsdf.alpha;
      lobe.view = to_world(bsdf, bsdf.view);
    }
    // With nothing to go by all lights are weighed as by a Lambertian surface.
    if (!(lobe.diffuse + lobe.specular > 0)) lobe.diffuse = 1;
    return lobe;
  }
};
struct ByLambert {
  const LambertLobe& lobe;
  BsdfValue eval(vec3 direction) const {
    float pdf = eval_lambert_pdf(lobe, direction);
    return {vec3(pdf), vec3(0), pdf, 0};
  }
  float pdf(const BsdfValue& value) const { return value.diffuse_pdf; }
  LobeHint hint() const { return {}; }
};

// Holds the wavelengths of what the lobes of a surface send on.
class LobeTints {
 public:
  LobeTints(const Transport& transport, const Walk& walk, const Material* material,
            uint32_t dimensions, Sampler& sampler) {
    const int reflectance = material ? material->spectra.reflectance : -1;
    if (walk.wavelengths.tinted || (walk.wavelengths.in_color() && reflectance < 0)) return;
    tables_ = transport.tables.spectral.get();
    diffuse_ = specular_ = walk.wavelengths;
    if (!tables_ || reflectance < 0) return;
    reflect(transport, reflectance, dimensions, sampler, diffuse_);
    if (tints_gloss(*material)) specular_ = diffuse_;
  }
  vec3 diffuse(int lamp) const { return tables_ ? tint_of(*tables_, diffuse_, lamp) : vec3(1); }
  vec3 specular(int lamp) const { return tables_ ? tint_of(*tables_, specular_, lamp) : vec3(1); }

 private:
  const SpectralTables* tables_ = nullptr;  // null: all is in colour
  Wavelengths diffuse_, specular_;
};

// `side`: the result of lit_side. `material`: null: no reflectance of it is known by wavelength.
template <class Scattering>
DirectLight direct_light(const Transport& transport, const Walk& walk, const SurfacePlace& place,
                         const Material* material, vec3 side, vec3 normal,
                         const Scattering& scattering, bool apart, Sampler& sampler) {
  const LightTables& tables = transport.tables;
  const uint32_t base = sampler.drawn;
  const LobeTints tints(transport, walk, material, base, sampler);
  sampler.seek(base);
  DirectLight direct;
  bool area = tables.area_share > 0, punctual = !tables.punctual.empty();
  float area_chance = 1, punctual_chance = 1;
  if (!apart && area && punctual) {
    area_chance = tables.area_share;
    punctual_chance = 1 - area_chance;
    (sampler.next() < area_chance ? punctual : area) = false;
  }
  auto arriving = [&](const LightSample& light, float chance) {
    return light.radiance * eval_visibility(transport, place, light) *
           eval_absorption(transport, medium_towards(walk.media, place, light.direction),
                           light.distance) /
           chance;
  };
  if (area) {
    sampler.seek(base + 1);
    LightSample light = sample_area_light(transport, place, side, sampler);
    float light_pdf = light.pdf * area_chance;
    if (light.pdf > 0 && max_component(light.radiance) > 0) {
      BsdfValue value = scattering.eval(light.direction);
      if (max_component(value.diffuse + value.specular) > 0) {
        vec3 arrives = arriving(light, light_pdf);
        float both = scattering.pdf(value);
        direct.area_direction = light.direction;
        direct.area_arrives = arrives * mis_weight(light_pdf, both);
        direct.area_diffuse = value.diffuse * arrives * tints.diffuse(light.spectrum) *
                              mis_weight(light_pdf, apart ? value.diffuse_pdf : both);
        direct.specular = value.specular * arrives * tints.specular(light.spectrum) *
                          mis_weight(light_pdf, apart ? value.specular_pdf : both);
      }
    }
  }
  if (punctual) {
    bool through = side == vec3(0);
    sampler.seek(base + Dimensions::punctual);
    LightSample light =
        sample_punctual_light(transport, place, normal, through, sampler, scattering.hint());
    direct.punctual_share = light.share;
    if (light.pdf > 0) {
      BsdfValue value = scattering.eval(light.direction);
      if (max_component(value.diffuse + value.specular) > 0) {
        vec3 arrives = arriving(light, punctual_chance);
        direct.punctual_diffuse = value.diffuse * arrives * tints.diffuse(light.spectrum);
        direct.punctual_direction = light.direction;
        direct.punctual_arrives = arrives;
        direct.specular += value.specular * arrives * tints.specular(light.spectrum);
      }
    }
  }
  return direct;
}

}  // namespace

DirectLight sample_direct_light(const Transport& transport, const Walk& walk,
                                const Surface& surface, const Bsdf& bsdf, bool apart,
                                Sampler& sampler) {
  const Material& material = transport.world.scene().materials[size_t(surface.material)];
  return direct_light(transport, walk, surface, &material, lit_side(surface, bsdf), bsdf.normal,
                      ByBsdf{bsdf}, apart, sampler);
}

DirectLight sample_direct_light(const Transport& transport, const Walk& walk,
                                const SurfacePlace& place, const LambertLobe& lobe, bool apart,
                                Sampler& sampler) {
  return direct_light(transport, walk, place, nullptr, place.geometric_normal, lobe.normal,
                      ByLambert{lobe}, apart, sampler);
}

namespace {

void make_blunt(const WalkRules& rules, const Walk& walk, Surface& surface) {
  constexpr float bluntest = 0.25f;
  bool perfect = alpha_of(surface.roughness) == 0;  // no lamp without a size has a highlight there
  if (!(walk.pdf > 0) || perfect || surface.transmission > 0) return;
  float alpha = std::min(bluntest, rules.blunt / std::sqrt(walk.pdf));
  surface.roughness = std::max(surface.roughness, std::sqrt(alpha));
  surface.clearcoat_roughness = std::max(surface.clearcoat_roughness, std::sqrt(alpha));
}

bool may_end(const Transport& transport, const Walk& walk, const Hit& hit, vec3& light) {
  const bool sharp = walk.pdf <= 0 || walk.pdf > wide;
  return walk.media.here.count == 0 && find_kept_light(transport, walk.ray, hit, sharp, light);
}

// Does one step of the walk at a Lambertian surface. Returns false if the walk ends there.
bool scatter_lambert(const Transport& transport, const WalkRules& rules, Walk& walk, const Hit& hit,
                     uint32_t base, Sampler& sampler, vec3& radiance) {
  bool last = walk.scattered >= rules.scatterings || walk.depth >= rules.max_depth;
  if (last) return false;
  LambertSurface surface = eval_lambert_surface(transport.world, walk.ray, hit);
  LambertLobe lobe = make_lambert(surface, walk.ray.direction);
  if (!(max_component(lobe.reflectance) > 0)) return false;
  if (vec3 light; may_end(transport, walk, hit, light)) {
    radiance += walk.throughput * walk_tint(transport, walk) * lobe.reflectance * light;
    return false;
  }
  absorb(transport, walk, hit.t, base, sampler);
  reflect(transport, hit, base, sampler, walk.wavelengths);
  sampler.seek(base);
  radiance += walk.throughput * lobe.reflectance *
              sample_direct_light(transport, walk, surface, lobe, false, sampler).sum();
  sampler.seek(base + Dimensions::scatter + 1);  // as sample_bsdf has it without a choice
  if (!advance(walk, surface, sample_lambert(lobe, sampler.next2()))) return false;
  walk.area_share = transport.tables.area_share;
  sampler.seek(base + Dimensions::survival);
  return survives(walk, sampler);
}

}  // namespace

vec3 follow(const Transport& transport, const WalkRules& rules, Walk walk, Sampler& sampler) {
  return follow(transport, rules, walk, transport.world.intersect(walk.ray), sampler);
}

vec3 follow(const Transport& transport, const WalkRules& rules, Walk walk, Hit hit,
            Sampler& sampler) {
  const World& world = transport.world;
  vec3 radiance(0);
  const uint32_t block = sampler.drawn;
  for (uint32_t base = block;; base += Dimensions::surface, hit = world.intersect(walk.ray)) {
    if (ends_in_volume(transport, walk, hit.t, radiance)) return radiance;
    if (!hit.valid()) return radiance + walk.throughput * walk_met_sky(transport, walk);
    if (met_lambertian(transport, hit)) {
      if (!scatter_lambert(transport, rules, walk, hit, base, sampler, radiance)) return radiance;
      continue;
    }
    Surface surface = meet_surface(transport, walk.ray, hit, walk.media);
    const Material& material = world.material_of(hit.instance);
    absorb(transport, walk, hit.t, base, sampler);
    radiance += walk.throughput * walk_met_emission(transport, walk, surface, material);
    if (material.unlit) return radiance;

    const bool ends = walk.scattered >= rules.scatterings, last = walk.depth >= rules.max_depth;
    const bool solid = material.thickness > 0 && surface.transmission > 0;
    if (ends || (last && !solid)) {  // the walk goes only straight on, as a shadow ray would
      if (!is_pane(surface, material)) return radiance;
      BsdfSample straight;
      straight.direction = walk.ray.direction;
      straight.weight = pane_transmittance(surface, material, walk.ray.direction);
      straight.bounce = Bounce::pass;
      if (!advance(walk, surface, straight)) return radiance;
      continue;
    }
    if (rules.blunt > 0) make_blunt(rules, walk, surface);
    Bsdf bsdf = make_bsdf_in(transport, walk.media, surface, material, walk.ray.direction);
    if (last && !is_clear_solid(bsdf)) return radiance;
    if (vec3 light; may_end(transport, walk, hit, light)) {
      radiance += walk.throughput * walk_tint(transport, walk) * kept_reflectance(bsdf) * light;
      if (!has_sharp_gloss(bsdf)) return radiance;
      bsdf.diffuse = vec3(0), bsdf.diffuse_share = 0;
    }
    std::optional<WavelengthSpread> spread;
    part_colors(transport, walk, surface, base, sampler, bsdf, spread);
    bool smooth = is_smooth(bsdf);
    sampler.seek(base);
    if (!smooth)
      radiance += walk.throughput *
                  sample_direct_light(transport, walk, surface, bsdf, false, sampler).sum();
    sampler.seek(base + Dimensions::scatter);
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::all, sampler);
    if (spread) carry_wavelengths(*spread, bsdf, Lobes::all, scattered, walk.wavelengths);
    reflect(transport, material, bsdf, Lobes::all, base, sampler, scattered, walk.wavelengths);
    if (!advance(walk, surface, scattered) || walk.depth > rules.max_depth) return radiance;
    if (scattered.bounce != Bounce::pass) {
      walk.area_share = scattered.pdf > 0 ? transport.tables.area_share : 0;
      walk.from_normal = lit_side(surface, bsdf);
    }
    if (scattered.bounce == Bounce::refract) walk.density *= bsdf.eta * bsdf.eta;
    sampler.seek(base + Dimensions::survival);
    if (!survives(walk, sampler)) return radiance;
  }
}

}  // namespace wellspring::light
