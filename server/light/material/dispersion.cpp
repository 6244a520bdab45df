// SPDX-License-Identifier: Apache-2.0
#include "light/material/dispersion.h"

#include <algorithm>
#include <cmath>

#include "light/material/bsdf_gloss.h"

namespace wellspring::light {
namespace {

// Updates the cluster after an event with these values and densities (the hero's not 0). Returns
// the event's weight.
vec3 add_event(Wavelengths& w, vec3 before, const vec3* value, const float* density) {
  vec3 scale(0);
  for (int i = 0; i < w.carried; i++) scale = glm::max(scale, value[i]);
  for (int i = 0; i < w.carried; i++) {
    w.value[i] *= divide_tint(value[i], scale);
    w.density[i] *= density[i] / density[0];
  }
  return divide_tint(tint_of(w), before) * (scale / density[0]);
}

vec3 sum_of(const BsdfValue& value, Lobes lobes) {
  return (lobes != Lobes::specular ? value.diffuse : vec3(0)) +
         (lobes != Lobes::diffuse ? value.specular : vec3(0));
}

}  // namespace

float index_at(const Material& material, float wavelength) {
  float abbe = 20 / material.dispersion;
  float bent =
      material.ior + (material.ior - 1) / abbe * (523655 / (wavelength * wavelength) - 1.5168f);
  return std::isfinite(bent) ? std::max(bent, 1.0f) : material.ior;
}

bool is_dispersive(const Surface& surface, const Material& material) {
  return material.dispersion > 0 && material.thickness > 0 && surface.transmission > 0 &&
         surface.metallic < 1 && material.ior > 1;
}

void spread_wavelengths(const Surface& surface, const Material& material, vec3 direction,
                        const DielectricAlbedo& albedo, const Wavelengths& carried, float u,
                        Bsdf& bsdf, std::optional<WavelengthSpread>& spread, float outside) {
  spread.emplace();
  spread->before = carried;
  Wavelengths& w = spread->before;
  if (carried.carried == 0) {
    spread->fresh = true;
    w.carried = wavelength_count;
    w.place = u;
    std::fill_n(w.value, wavelength_count, vec3(1));
    std::fill_n(w.density, wavelength_count, 1.0f);
  }
  auto made = [&](int i) {
    float index = index_at(material, wavelength_at(place_of(w, i)));
    return make_bsdf(surface, material, direction, albedo, index, outside);
  };
  bsdf = made(0);
  for (int i = 1; i < w.carried; i++) spread->others[i - 1] = made(i);
  bsdf.spread = &*spread;
}

void carry_wavelengths(const WavelengthSpread& spread, const Bsdf& bsdf, Lobes lobes,
                       BsdfSample& sample, Wavelengths& carried) {
  if (sample.weight == vec3(0)) return;
  carried = spread.before;
  Bsdf hero = bsdf;
  hero.spread = nullptr;
  vec3 before = tint_before(spread), value[wavelength_count];
  float density[wavelength_count];
  if (sample.pdf == 0) {  // a perfect lobe
    bool mirrored = sample.bounce == Bounce::reflect && !has_clearcoat(hero);
    if (!mirrored || carried.carried == 1) {
      carry_hero(spread, sample, carried);
      return;
    }
    FacetColor first = facet_color(hero, hero.view.z);
    vec3 rest = divide_tint(sample.weight * first.reflect_share, first.reflect);
    for (int i = 0; i < carried.carried; i++) {
      const Bsdf& b = i == 0 ? hero : spread.others[i - 1];
      FacetColor color = facet_color(b, b.view.z);
      value[i] = color.reflect;
      density[i] = color.reflect_share;
    }
    sample.weight = rest * add_event(carried, before, value, density);
    return;
  }
  float mean = 0, sum = 0;
  for (int i = 0; i < carried.carried; i++) {
    const Bsdf& b = i == 0 ? hero : spread.others[i - 1];
    BsdfValue each = eval_bsdf(b, sample.direction);
    value[i] = sum_of(each, lobes);
    density[i] = sample_bsdf_pdf(b, each, lobes);
    mean += carried.density[i] * density[i];
    sum += carried.density[i];
  }
  if (!(density[0] > 0)) {
    sample.weight = vec3(0);
    return;
  }
  sample.weight = add_event(carried, before, value, density);
  sample.pdf = mean / sum;
}

vec3 hero_tint(const WavelengthSpread& spread) {
  Wavelengths hero = spread.before;
  hero.carried = 1;
  return divide_tint(tint_of(hero), tint_before(spread));
}

void carry_hero(const WavelengthSpread& spread, BsdfSample& sample, Wavelengths& carried) {
  if (sample.weight == vec3(0)) return;
  sample.weight *= hero_tint(spread);
  carried = spread.before;
  carried.carried = 1;
}

}  // namespace wellspring::light
