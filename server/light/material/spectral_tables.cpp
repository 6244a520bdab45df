// SPDX-License-Identifier: Apache-2.0
#include "light/material/spectral_tables.h"

#include <algorithm>
#include <cmath>

#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "spectrum/wavelength_density.h"
#include "world/load/scene_spectra.h"

namespace wellspring::light {
namespace {

const Spectrum& white_power() {
  static const Spectrum power = find_lamp("D65")->power;
  return power;
}

// Returns what each nanometre of D65 adds to red, green and blue of a white surface.
const std::array<dvec3, spectrum_size>& color_weights() {
  static const auto made = [] {
    std::array<dvec3, spectrum_size> weights = LampObserver(white_power()).weights();
    dvec3 sum(0);
    for (dvec3& weight : weights) sum += weight = rgb_of(weight);
    for (dvec3& weight : weights) weight /= sum;
    return weights;
  }();
  return made;
}

// Returns the power of a lamp by nanometre as its share of all that is seen.
Spectrum seen_power(const Spectrum& power) {
  Spectrum seen;
  double sum = 0;
  for (size_t i = 0; i < spectrum_size; i++) {
    const dvec3& eye = matching_functions()[i];
    sum += seen[i] = power[i] * (eye.x + eye.y + eye.z);
  }
  for (double& share : seen) share = sum > 0 ? share / sum : 0;
  return seen;
}

// A line holds this share of a lamp's light within a nanometre.
constexpr double line_share = 0.04;

// Returns the chance of each nanometre.
Spectrum wavelength_chances(const Scene& scene, const std::vector<char>& is_lamp) {
  const WavelengthDensity density(first_nm - 0.5, last_nm + 0.5);
  Spectrum chances{}, lines{};
  int lined = 0;
  for (size_t s = 0; s < is_lamp.size(); s++) {
    if (!is_lamp[s]) continue;
    const Spectrum seen = seen_power(scene.spectra[s].value);
    if (*std::max_element(seen.begin(), seen.end()) < line_share) continue;
    for (size_t i = 0; i < spectrum_size; i++) lines[i] += seen[i];
    lined++;
  }
  double sum = 0;
  for (size_t i = 0; i < spectrum_size; i++) sum += chances[i] = density.at(nm_of(i));
  for (size_t i = 0; i < spectrum_size; i++) {
    chances[i] /= sum;
    if (lined > 0) chances[i] = (chances[i] + lines[i] / lined) / 2;
  }
  return chances;
}

void set_responses(const Spectrum& chances, bool exact, SpectralTables& tables) {
  const std::array<dvec3, spectrum_size>& weights = color_weights();
  dvec3 shown(0);
  double below = 0;
  for (size_t i = 0; i < spectrum_size; i++) {
    shown += glm::max(weights[i], dvec3(0));
    tables.below[i] = float(below);
    below += chances[i];
  }
  tables.below[spectrum_size] = 1;
  size_t at = 0;
  for (size_t k = 0; k < SpectralTables::guide_size; k++) {
    while (at + 1 < spectrum_size &&
           tables.below[at + 1] <= float(k) / float(SpectralTables::guide_size))
      at++;
    tables.guide[k] = uint16_t(at);
  }
  for (size_t i = 0; i < spectrum_size; i++) {
    tables.shown[i] = vec3(glm::max(weights[i], dvec3(0)) / shown / chances[i]);
    tables.response[i] = exact ? vec3(weights[i] / chances[i]) : tables.shown[i];
  }
}

std::vector<char> find_lamps(const Scene& scene) {
  std::vector<char> is_lamp(scene.spectra.size(), 0);
  auto mark = [&](int spectrum) {
    if (spectrum >= 0) is_lamp[size_t(spectrum)] = 1;
  };
  for (const PunctualLight& light : scene.lights) mark(light.spectrum);
  for (const Material& material : scene.materials) mark(material.spectra.emission);
  for (const Lamp& lamp : scene.lamps)
    for (const LampLight& light : lamp.dial) mark(light.spectrum);
  return is_lamp;
}

// Returns the light of a lamp of that relative power (as in the rows) that a reflectance sends on.
vec3 reflected(const NanometreRow* lamp, const NanometreRow& reflectance) {
  dvec3 sum(0);
  for (size_t i = 0; i < spectrum_size; i++)
    sum += color_weights()[i] * double(lamp ? (*lamp)[i] : 1.0f) * double(reflectance[i]);
  return vec3(sum);
}

}  // namespace

std::shared_ptr<const SpectralTables> make_spectral_tables(const Scene& scene) {
  auto tables = std::make_shared<SpectralTables>();
  const std::vector<char> is_lamp = find_lamps(scene);
  set_responses(wavelength_chances(scene, is_lamp), true, *tables);
  const size_t count = scene.spectra.size();
  tables->rows.resize(count);
  tables->colors.resize(count, vec3(1));
  const double white = xyz_of(white_power()).y;
  for (size_t s = 0; s < count; s++) {
    const Spectrum& value = scene.spectra[s].value;
    const double scale = is_lamp[s] ? white / xyz_of(value).y : 0;
    for (size_t i = 0; i < spectrum_size; i++)
      tables->rows[s][i] = float(is_lamp[s] ? scale * value[i] / white_power()[i] : value[i]);
    if (is_lamp[s]) tables->colors[s] = lamp_color(value);
  }
  tables->reflected_once.assign((count + 1) * count, vec3(1));
  for (const Material& material : scene.materials) {
    const int reflectance = material.spectra.reflectance;
    if (reflectance < 0) continue;
    // Walks carry a reflectance's index and no material, so its colour is in the tables, too.
    tables->colors[size_t(reflectance)] = material.spectra.base;
    for (size_t lamp = 0; lamp <= count; lamp++) {
      if (lamp > 0 && !is_lamp[lamp - 1]) continue;
      const NanometreRow* power = lamp > 0 ? &tables->rows[lamp - 1] : nullptr;
      const vec3 color = lamp > 0 ? tables->colors[lamp - 1] : vec3(1);
      tables->reflected_once[lamp * count + size_t(reflectance)] =
          reflected(power, tables->rows[size_t(reflectance)]) / (color * material.spectra.base);
    }
  }
  return tables;
}

std::shared_ptr<const SpectralTables> plain_spectral_tables() {
  static const auto made = [] {
    auto tables = std::make_shared<SpectralTables>();
    set_responses(wavelength_chances({}, {}), false, *tables);
    return tables;
  }();
  return made;
}

float wavelength_at(const SpectralTables& tables, float place) {
  constexpr size_t last = SpectralTables::guide_size - 1;
  const auto& below = tables.below;
  size_t i = tables.guide[std::min(size_t(std::max(place, 0.0f) * float(last + 1)), last)];
  while (i + 1 < spectrum_size && below[i + 1] <= place) i++;
  const float from = below[i], to = below[i + 1];
  const float along = to > from ? (place - from) / (to - from) : 0.5f;
  return float(first_nm) + float(i) - 0.5f + along;
}

float value_at(const NanometreRow& row, float nm) {
  const float x = glm::clamp(nm - float(first_nm), 0.0f, float(spectrum_size - 1));
  const size_t i = std::min(size_t(x), spectrum_size - 2);
  return glm::mix(row[i], row[i + 1], x - float(i));
}

}  // namespace wellspring::light
