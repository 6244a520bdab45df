// SPDX-License-Identifier: Apache-2.0
#include "light/material/dispersion.h"

#include <algorithm>
#include <cmath>

#include "light/material/bsdf_gloss.h"

namespace wellspring::light {
namespace {

// Adds an event with these values and densities, of which the hero's are above 0. Both are kept
// over the hero's, so that no product of many becomes too small.
void add_event(Wavelengths& w, const float* value, const float* density) {
  for (int i = 0; i < w.carried; i++) {
    w.value[i] *= value[i] / value[0];
    w.density[i] *= density[i] / density[0];
  }
}

float sum_of(vec3 color) { return color.x + color.y + color.z; }

vec3 sum_of(const BsdfValue& value, Lobes lobes) {
  return (lobes != Lobes::specular ? value.diffuse : vec3(0)) +
         (lobes != Lobes::diffuse ? value.specular : vec3(0));
}

// Returns whether the event was one of a perfect mirror; sets what it was to each wavelength.
bool find_mirrored(const WavelengthSpread& spread, const Bsdf& hero, const BsdfSample& sample,
                   float* value, float* density) {
  if (sample.bounce != Bounce::reflect || has_clearcoat(hero)) return false;
  for (int i = 0; i < spread.before.carried; i++) {
    Bsdf b = hero;
    const float bent = spread.index[i] / spread.index[0];
    b.eta *= hero.within ? 1 / bent : bent;
    const FacetColor color = facet_color(b, b.view.z);
    value[i] = sum_of(color.reflect);
    density[i] = color.reflect_share;
  }
  return true;
}

}  // namespace

float index_at(const SpectralTables& tables, const Material& material, float wavelength) {
  if (material.spectra.index >= 0)
    return value_at(tables.rows[size_t(material.spectra.index)], wavelength);
  float abbe = 20 / material.dispersion;
  float bent =
      material.ior + (material.ior - 1) / abbe * (523655 / (wavelength * wavelength) - 1.5168f);
  return std::isfinite(bent) ? std::max(bent, 1.0f) : material.ior;
}

bool is_dispersive(const Surface& surface, const Material& material) {
  return material.dispersion > 0 && material.thickness > 0 && surface.transmission > 0 &&
         surface.metallic < 1 && material.ior > 1;
}

void spread_wavelengths(const SpectralTables& tables, const Surface& surface,
                        const Material& material, vec3 direction, const DielectricAlbedo& albedo,
                        const Wavelengths& carried, float place, Bsdf& bsdf,
                        std::optional<WavelengthSpread>& spread, float outside) {
  spread.emplace();
  spread->tables = &tables;
  spread->before = carried;
  spread->tint_before = shown_tint(tables, carried);
  Wavelengths& w = spread->before;
  if (carried.carried == 0) begin_cluster(tables, place, w);
  for (int i = 0; i < w.carried; i++) spread->index[i] = index_at(tables, material, w.nm[i]);
  auto made = [&](int i) {
    return make_bsdf(surface, material, direction, albedo, spread->index[i], outside);
  };
  bsdf = made(0);
  if (!is_smooth(bsdf)) spread->made = w.carried - 1;
  for (int i = 0; i < spread->made; i++) spread->others[i] = made(i + 1);
  bsdf.spread = &*spread;
}

void carry_wavelengths(const WavelengthSpread& spread, const Bsdf& bsdf, Lobes lobes,
                       BsdfSample& sample, Wavelengths& carried) {
  if (sample.weight == vec3(0)) return;
  carried = spread.before;
  if (carried.carried == 1) return;
  Bsdf hero = bsdf;
  hero.spread = nullptr;
  float value[wavelength_count], density[wavelength_count];
  if (sample.pdf == 0) {
    if (!find_mirrored(spread, hero, sample, value, density)) return carry_hero(spread, carried);
    return add_event(carried, value, density);
  }
  float mean = 0, sum = 0;
  for (int i = 0; i < carried.carried; i++) {
    const Bsdf& b = i == 0 ? hero : spread.others[i - 1];
    BsdfValue each = eval_bsdf(b, sample.direction);
    value[i] = sum_of(sum_of(each, lobes));
    density[i] = sample_bsdf_pdf(b, each, lobes);
    mean += carried.density[i] * density[i];
    sum += carried.density[i];
  }
  if (!(density[0] > 0) || !(value[0] > 0)) {
    sample.weight = vec3(0);
    return;
  }
  add_event(carried, value, density);
  sample.pdf = mean / sum;
}

vec3 hero_tint(const WavelengthSpread& spread) {
  Wavelengths hero = spread.before;
  hero.carried = 1;
  return divide_tint(shown_tint(*spread.tables, hero), spread.tint_before);
}

void carry_hero(const WavelengthSpread& spread, Wavelengths& carried) {
  carried = spread.before;
  carried.carried = 1;
}

void tint_weight(const WavelengthSpread& spread, Wavelengths& carried, BsdfSample& sample) {
  if (sample.weight == vec3(0)) return;
  carried.tinted = true;
  sample.weight *= divide_tint(shown_tint(*spread.tables, carried), spread.tint_before);
}

}  // namespace wellspring::light
