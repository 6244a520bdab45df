// SPDX-License-Identifier: Apache-2.0
// Puts what is known by wavelength into a scene. Colours follow: whoever knows three colours alone
// sees a spectral material under D65, and a spectral lamp in its own colour.
#pragma once
#include <string>

#include "spectrum/glass.h"
#include "world/scene.h"

namespace wellspring::world {

// Return linear Rec. 709 colours of a lamp's relative power (with Y of 1) and of a reflectance
// under D65, of which no channel is above 1. Colours beyond a display's are cut: each channel is at
// least a thousandth of the largest, so that they can be divided by.
vec3 lamp_color(const Spectrum& power);
vec3 reflectance_color(const Spectrum& reflectance);

// Adds a spectrum to the scene and returns its index.
int add_spectrum(Scene& scene, std::string name, const Spectrum& value);

// Set what materials are by wavelength; the spectrum is an index into Scene::spectra.
// The base colour's factor is multiplied by the reflectance.
void set_reflectance(Scene& scene, Material& material, int reflectance);
// Makes the base colour's own factor a smooth reflectance (spectrum/upsample.h).
void upsample_base_color(Scene& scene, Material& material);
// Sets how glass bends light. Beyond the glass's range the index at its end holds. Returns false if
// no index is known at 587.6 nm.
bool set_glass(Scene& scene, Material& material, const Dispersion& glass);
// Sets the absorption inside a solid, per metre.
void set_absorption(const Scene& scene, Material& material, int absorption);
// Sets the relative power of all lights and surfaces of a lamp, which keep their luminance.
void set_lamp_spectrum(Scene& scene, const Lamp& lamp, int power);

}  // namespace wellspring::world
