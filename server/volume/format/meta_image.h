// SPDX-License-Identifier: Apache-2.0
// MetaImage (MetaIO of ITK): .mha with its samples behind the header, .mhd with them in one file or
// in several; plain, or packed by zlib to the end of the file: CompressedDataSize is not believed,
// since there are files where it is wrong. Spaces are LPS and millimetres, as of ITK, unless
// DistanceUnits says otherwise; AnatomicalOrientation counts where there is no TransformMatrix.
#pragma once
#include <string>

#include "volume/format/stored_volume.h"

namespace wellspring::volume {

// Says whether a text begins as a header of MetaImage does.
bool is_meta_image(std::string_view first_bytes);

// Throws LoadError.
StoredVolume read_meta_header(const std::string& file);

}  // namespace wellspring::volume
