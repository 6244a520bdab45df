// SPDX-License-Identifier: Apache-2.0
#include "world/load/scene_spectra.h"

#include <algorithm>
#include <cmath>

#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "spectrum/upsample.h"

namespace wellspring::world {
namespace {

const LampObserver& daylight_observer() {
  static const LampObserver observer(find_lamp("D65")->power);
  return observer;
}

vec3 usable(const dvec3& xyz) {
  const vec3 color(rgb_of(xyz));
  const float most = std::max(max_component(color), 1e-3f);
  return max(color, vec3(1e-3f * most));
}

// Returns the length in metres after which half of the light that is seen is left; infinite where
// nothing is taken up.
double half_length(const Spectrum& absorption) {
  auto left = [&](double metres) {
    Spectrum share;
    for (size_t i = 0; i < spectrum_size; i++) share[i] = std::exp(-absorption[i] * metres);
    return daylight_observer().xyz(share).y;
  };
  double low = 1e-7, high = 1e4;
  if (left(high) > 0.5) return std::numeric_limits<double>::infinity();
  for (int i = 0; i < 60; i++)
    (left(std::sqrt(low * high)) > 0.5 ? low : high) = std::sqrt(low * high);
  return high;
}

}  // namespace

vec3 lamp_color(const Spectrum& power) {
  const dvec3 xyz = xyz_of(power);
  return xyz.y > 0 ? usable(xyz / xyz.y) : vec3(1);
}

vec3 reflectance_color(const Spectrum& reflectance) {
  return min(usable(daylight_observer().xyz(reflectance)), vec3(1));
}

int add_spectrum(Scene& scene, std::string name, const Spectrum& value) {
  scene.spectra.push_back({std::move(name), value});
  return int(scene.spectra.size()) - 1;
}

void set_reflectance(Scene& scene, Material& material, int reflectance) {
  material.spectra.reflectance = reflectance;
  material.spectra.base = reflectance_color(scene.spectra[size_t(reflectance)].value);
  material.base_color *= vec4(material.spectra.base, 1);
}

void upsample_base_color(Scene& scene, Material& material) {
  const Spectrum fitted = sample_reflectance(fit_reflectance(dvec3(material.base_color)));
  material.base_color = vec4(1, 1, 1, material.base_color.w);
  set_reflectance(scene, material, add_spectrum(scene, material.name, fitted));
}

bool set_glass(Scene& scene, Material& material, const Dispersion& glass) {
  const std::optional<double> index = index_at(glass, line_d_nm);
  if (!index) return false;
  Spectrum row;
  for (size_t i = 0; i < spectrum_size; i++) {
    const double nm = glm::clamp(nm_of(i), std::ceil(glass.low_nm), std::floor(glass.high_nm));
    row[i] = std::max(index_at(glass, nm).value_or(*index), 1.0);
  }
  material.spectra.index = add_spectrum(scene, glass.name, row);
  material.ior = float(*index);
  // 20 over Abbe's number is what KHR_materials_dispersion has; some gems bend all lines alike.
  const std::optional<double> abbe = abbe_number(glass);
  material.dispersion = abbe && *abbe > 0 ? float(20 / *abbe) : 0.0f;
  return true;
}

void set_absorption(const Scene& scene, Material& material, int absorption) {
  const Spectrum& value = scene.spectra[size_t(absorption)].value;
  const double metres = half_length(value);
  if (!std::isfinite(metres)) return;
  Spectrum left;
  for (size_t i = 0; i < spectrum_size; i++) left[i] = std::exp(-value[i] * metres);
  material.spectra.absorption = absorption;
  material.attenuation_color = reflectance_color(left);
  material.attenuation_distance = float(metres);
}

void set_lamp_spectrum(Scene& scene, const Lamp& lamp, int power) {
  const vec3 color = lamp_color(scene.spectra[size_t(power)].value);
  for (int i : lamp.lights) {
    PunctualLight& light = scene.lights[size_t(i)];
    light.intensity = luminance(light.intensity) * color;
    light.spectrum = power;
  }
  for (int i : lamp.materials) {
    Material& material = scene.materials[size_t(i)];
    material.emission = luminance(material.emission) * color;
    material.spectra.emission = power;
  }
}

}  // namespace wellspring::world
