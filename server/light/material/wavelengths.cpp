// SPDX-License-Identifier: Apache-2.0
#include "light/material/wavelengths.h"

#include <algorithm>
#include <cmath>

namespace wellspring::light {
namespace {

// Returns the sum of values times responses over that of densities, still with `colored`.
vec3 mean_response(const Wavelengths& w, const std::array<vec3, spectrum_size>& response,
                   const NanometreRow* lamp) {
  vec3 sum(0);
  float density = 0;
  for (int i = 0; i < w.carried; i++) {
    const size_t nm = nanometre_of(w.nm[i]);
    sum += (w.value[i] * (lamp ? (*lamp)[nm] : 1.0f)) * response[nm];
    density += w.density[i];
  }
  return density > 0 ? sum / density : vec3(0);
}

// Takes `colored` out of a colour. A channel that solids have swallowed all but whole is dark: what
// is left of it would be divided by next to nothing.
constexpr float least_colored = 1e-30f;
vec3 uncolored(vec3 color, vec3 colored) {
  for (int c = 0; c < 3; c++) color[c] = colored[c] > least_colored ? color[c] / colored[c] : 0;
  return color;
}

}  // namespace

vec3 tint_of(const SpectralTables& tables, const Wavelengths& w, int lamp) {
  if (w.tinted) return vec3(1);
  if (w.carried == 0) return w.reflected < 0 ? vec3(1) : reflected_once(tables, lamp, w.reflected);
  if (lamp < 0) return uncolored(mean_response(w, tables.response, nullptr), w.colored);
  return uncolored(mean_response(w, tables.response, &tables.rows[size_t(lamp)]),
                   w.colored * tables.colors[size_t(lamp)]);
}

vec3 shown_tint(const SpectralTables& tables, const Wavelengths& w) {
  return w.carried == 0 ? max(tint_of(tables, w), vec3(0))
                        : uncolored(mean_response(w, tables.shown, nullptr), w.colored);
}

void begin_cluster(const SpectralTables& tables, float place, Wavelengths& w) {
  w.carried = wavelength_count;
  w.place = place;
  for (int i = 0; i < wavelength_count; i++) {
    const float at = place + float(i) / wavelength_count;
    w.nm[i] = wavelength_at(tables, at < 1 ? at : at - 1);
  }
  w.value = w.density = all_lanes(1);
  w.colored = vec3(1);
  const int reflected = w.reflected;
  w.reflected = -1;
  if (reflected >= 0) reflect_wavelengths(tables, reflected, w);
}

void reflect_wavelengths(const SpectralTables& tables, int reflectance, Wavelengths& w) {
  if (w.carried == 0) {
    w.reflected = reflectance;
    return;
  }
  const NanometreRow& row = tables.rows[size_t(reflectance)];
  for (int i = 0; i < w.carried; i++) w.value[i] *= row[nanometre_of(w.nm[i])];
  w.colored *= tables.colors[size_t(reflectance)];
}

void absorb_wavelengths(const SpectralTables& tables, int absorption, float metres, vec3 tint,
                        Wavelengths& w) {
  const NanometreRow& row = tables.rows[size_t(absorption)];
  for (int i = 0; i < w.carried; i++) w.value[i] *= std::exp(-row[nanometre_of(w.nm[i])] * metres);
  w.colored *= tint;
}

vec3 meet_hues(const SpectralTables& tables, float eye, float light) {
  if (eye < 0 || light < 0) return vec3(1);
  if (std::abs(eye - light) > hue_bandwidth / 2) return vec3(0);
  // Less of the spectrum is within reach at its ends.
  float reach = std::min(eye + hue_bandwidth / 2, 1.0f) - std::max(eye - hue_bandwidth / 2, 0.0f);
  // Both have coloured it.
  return divide_tint(vec3(1 / reach), tables.shown[nanometre_of(wavelength_at(tables, light))]);
}

void blend_wavelengths(const WavelengthSpread& spread, const BsdfValue* others, BsdfValue& value) {
  const Wavelengths& w = spread.before;
  vec3 colored(0);
  float chance = 0, sum = 0;
  for (int i = 0; i < w.carried; i++) {
    const BsdfValue& each = i == 0 ? value : others[i - 1];
    colored += w.value[i] * each.specular * spread.tables->shown[nanometre_of(w.nm[i])];
    chance += w.density[i] * each.specular_pdf;
    sum += w.density[i];
  }
  value.specular = divide_tint(uncolored(colored / sum, w.colored), spread.tint_before);
  value.specular_pdf = chance / sum;
}

}  // namespace wellspring::light
