// SPDX-License-Identifier: Apache-2.0
// Holds what walks need to know of a scene's light by wavelength, nanometre by nanometre.
//
// Colours stand for light of D65: a lamp or a surface of which only a colour is known has that
// colour whatever the wavelength. So a scene pays for wavelengths only where something is known by
// wavelength.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "spectrum/spectrum.h"
#include "world/scene.h"

namespace wellspring::light {

using NanometreRow = std::array<float, spectrum_size>;

struct SpectralTables {
  // Share of wavelengths that are drawn below each nanometre's interval; the last is 1.
  std::array<float, spectrum_size + 1> below;
  // Nanometre in which the share k / guide_size of wavelengths lies: a search begins there.
  static constexpr size_t guide_size = 1024;
  std::array<uint16_t, guide_size> guide;
  // A wavelength brings so much to each channel, over the density with which it is drawn: the mean
  // over all that are drawn is 1. `response` is the observer's, which is below zero for hues that
  // are beyond the colours of a display; `shown` is cut at zero, for light that is kept in colours.
  std::array<vec3, spectrum_size> response, shown;
  // Scene::spectra one for one; of relative power: over that of D65, with the same Y.
  std::vector<NanometreRow> rows;
  std::vector<vec3> colors;  // colours of lamps and reflectances in the scene; each channel above 0
  // Light of a lamp that one surface has reflected, over the product of both colours: at
  // (lamp + 1) * rows.size() + reflectance; lamp -1 is light of a colour.
  std::vector<vec3> reflected_once;
};

// Makes the tables of a scene, which takes milliseconds for each of its lamps. Wavelengths are
// drawn by WavelengthDensity, half of them by the power of lamps with lines if there are some.
std::shared_ptr<const SpectralTables> make_spectral_tables(const Scene& scene);
// Returns the tables of a scene of which nothing is known by wavelength but glass that spreads
// colours (KHR_materials_dispersion): `response` is cut at zero, too.
std::shared_ptr<const SpectralTables> plain_spectral_tables();

// Returns the entry of `reflected_once`.
inline vec3 reflected_once(const SpectralTables& tables, int lamp, int reflectance) {
  return tables.reflected_once[size_t(lamp + 1) * tables.rows.size() + size_t(reflectance)];
}

// Returns the wavelength below which lies this share, 0 to 1, of all that are drawn; nanometres.
float wavelength_at(const SpectralTables& tables, float place);
inline size_t nanometre_of(float nm) {
  return size_t(glm::clamp(int(nm + 0.5f) - first_nm, 0, int(spectrum_size) - 1));
}
// Returns a row's value by straight lines between those of whole nanometres.
float value_at(const NanometreRow& row, float nm);

}  // namespace wellspring::light
