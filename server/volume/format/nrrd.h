// SPDX-License-Identifier: Apache-2.0
// NRRD (Definition of NRRD File Format, teem.sourceforge.net/nrrd/format.html), versions 1 to 5:
// header and samples in one file, or a header that names one file of samples or several; encodings
// raw and gzip. The unit is that of `space units`, millimetres if there is none. The spaces
// 3D-left-handed and 3D-right-handed, and a header without space, state no orientation; of these
// the left-handed one is mirrored (LAS), so that it stays what it is.
//
// An axis before those of space is colour if it has 3 or 4 samples of uint8, else a list, as an
// axis behind them is; one of them is taken.
#pragma once
#include <string>

#include "volume/format/stored_volume.h"

namespace wellspring::volume {

// Takes entry `entry` of a list that lies before the axes of space; a list behind them are times.
// Throws LoadError.
StoredVolume read_nrrd_header(const std::string& file, int64_t entry = 0);

}  // namespace wellspring::volume
