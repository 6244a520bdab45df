// SPDX-License-Identifier: Apache-2.0
// Shows a curator what is in a scanned volume.
#pragma once
#include <string>

#include "volume/draw/shown_volume.h"

namespace wellspring::program {

// Writes a PNG with the volume in each of the presets that its values propose, side by side, and
// tells of each on stderr. Throws LoadError.
void write_preview(const volume::ShownVolume& shown, const std::string& file);

}  // namespace wellspring::program
