// SPDX-License-Identifier: Apache-2.0
// SLC, the format of VolVis: a header of text, a small picture of three bytes a texel, then slices
// of 8-bit samples, each with its length, plain or as runs. Many writers leave out the last sample
// of each slice, which is then 0. It states no orientation, and its number for the unit is set
// by few: spacings are millimetres.
#pragma once
#include <cstddef>
#include <string>

#include "volume/format/stored_volume.h"

namespace wellspring::volume {

// Throws LoadError.
StoredVolume read_slc_header(const std::string& file);
// Fills the samples of all slices; throws LoadError that names the slice. Memory for one slice is
// bounded by the file's size.
void read_slc_samples(const StoredVolume& stored, std::byte* to);

}  // namespace wellspring::volume
