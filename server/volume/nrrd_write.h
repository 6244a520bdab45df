// SPDX-License-Identifier: Apache-2.0
// Writes volumes as NRRD files (teem.sourceforge.net/nrrd/format.html) that other programs read.
#pragma once
#include <string>
#include <vector>

#include "volume/volume.h"

namespace wellspring::volume {

// Returns a file with an attached header and gzip data, the same bytes each time: the channels, if
// there are more than one, on the first axis, places in millimetres from left to posterior to
// superior. The slope and intercept of whole numbers stand as "old min" and "old max", which say
// what the kind's least and largest number measure. Floats are written as what they measure.
std::vector<char> encode_nrrd(const Volume& volume);

// Writes that file. Throws LoadError if it cannot be written.
void save_nrrd(const std::string& file, const Volume& volume);

}  // namespace wellspring::volume
