// SPDX-License-Identifier: Apache-2.0
#include "light/material/wavelengths.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wellspring::light {
namespace {

constexpr float shortest = 390, longest = 730;  // nanometres
constexpr int places = 512;

float lobe(float x, float middle, float below, float above) {
  float t = (x - middle) / (x < middle ? below : above);
  return std::exp(-0.5f * t * t);
}

// Returns the functions of Wyman, Sloan and Shirley 2013, equation 4, as linear Rec. 709, cut at
// zero.
vec3 raw_response(float nm) {
  float x = 1.056f * lobe(nm, 599.8f, 37.9f, 31.0f) + 0.362f * lobe(nm, 442.0f, 16.0f, 26.7f) -
            0.065f * lobe(nm, 501.1f, 20.4f, 26.2f);
  float y = 0.821f * lobe(nm, 568.8f, 46.9f, 40.5f) + 0.286f * lobe(nm, 530.9f, 16.3f, 31.1f);
  float z = 1.217f * lobe(nm, 437.0f, 11.8f, 36.0f) + 0.681f * lobe(nm, 459.0f, 26.0f, 13.8f);
  return glm::max(
      vec3(3.2406f * x - 1.5372f * y - 0.4986f * z, -0.9689f * x + 1.8758f * y + 0.0415f * z,
           0.0557f * x - 0.2040f * y + 1.0570f * z),
      vec3(0));
}

struct Spectrum {
  std::array<float, places + 1> wavelength;  // first wavelength of each place
  std::array<vec3, places> response;         // mean over each place; the mean of all is 1
};

Spectrum make_spectrum() {
  constexpr int steps = 1 << 14;
  constexpr float step = (longest - shortest) / steps;
  glm::dvec3 total(0);
  auto at = [&](int i) { return glm::dvec3(raw_response(shortest + (float(i) + 0.5f) * step)); };
  for (int i = 0; i < steps; i++) total += at(i);
  Spectrum spectrum;
  spectrum.wavelength[0] = shortest;
  glm::dvec3 passed(0), begun(0);
  int place = 0;
  for (int i = 0; i < steps; i++) {
    glm::dvec3 share = at(i) / total;
    double before = (passed.x + passed.y + passed.z) / 3, part = (share.x + share.y + share.z) / 3;
    while (place < places - 1 && before + part >= double(place + 1) / places) {
      double along = part > 0 ? (double(place + 1) / places - before) / part : 1;
      glm::dvec3 end = passed + share * along;
      spectrum.wavelength[size_t(place) + 1] = shortest + (float(i) + float(along)) * step;
      spectrum.response[size_t(place++)] = vec3((end - begun) * double(places));
      begun = end;
    }
    passed += share;
  }
  spectrum.wavelength[places] = longest;
  spectrum.response[places - 1] = vec3((passed - begun) * double(places));
  return spectrum;
}

const Spectrum& spectrum() {
  static const Spectrum made = make_spectrum();
  return made;
}

}  // namespace

float wavelength_at(float place) {
  float x = glm::clamp(place, 0.0f, 1.0f) * places;
  size_t i = size_t(std::min(int(x), places - 1));
  return glm::mix(spectrum().wavelength[i], spectrum().wavelength[i + 1], x - float(i));
}

vec3 response_at(float place) {
  return spectrum().response[size_t(glm::clamp(int(place * places), 0, places - 1))];
}

vec3 tint_of(const Wavelengths& w) {
  vec3 sum(0);
  float density = 0;
  for (int i = 0; i < w.carried; i++) {
    sum += w.value[i] * response_at(place_of(w, i));
    density += w.density[i];
  }
  return density > 0 ? sum / density : vec3(0);
}

vec3 meet_hues(float eye, float light) {
  if (eye < 0 || light < 0) return vec3(1);
  if (std::abs(eye - light) > hue_bandwidth / 2) return vec3(0);
  // Less of the spectrum is within reach at its ends.
  float reach = std::min(eye + hue_bandwidth / 2, 1.0f) - std::max(eye - hue_bandwidth / 2, 0.0f);
  return divide_tint(vec3(1 / reach), response_at(light));  // both have coloured it
}

void blend_wavelengths(const WavelengthSpread& spread, const BsdfValue* others, BsdfValue& value) {
  const Wavelengths& w = spread.before;
  vec3 colored(0);
  float chance = 0, sum = 0;
  for (int i = 0; i < w.carried; i++) {
    const BsdfValue& each = i == 0 ? value : others[i - 1];
    colored += w.value[i] * each.specular * response_at(place_of(w, i));
    chance += w.density[i] * each.specular_pdf;
    sum += w.density[i];
  }
  value.specular = divide_tint(colored / sum, tint_before(spread));
  value.specular_pdf = chance / sum;
}

}  // namespace wellspring::light
