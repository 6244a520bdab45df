// SPDX-License-Identifier: Apache-2.0
// Reads what materials and lamps of a package are by wavelength, out of its exhibit.json: see
// content/README.md.
#pragma once
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Reads "spectra" into the scene's materials. Call when the scene is there, before lamps are read.
void read_spectra(Exhibit& exhibit, FieldReader& root);

// Reads the fields "spectrum" and "dial" of a lamp into `lamp` and the scene's `lit`.
void read_lamp_light(Exhibit& exhibit, FieldReader& fields, ExhibitLamp& lamp, int lit);

}  // namespace wellspring::show
