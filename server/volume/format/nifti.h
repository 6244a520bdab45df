// SPDX-License-Identifier: Apache-2.0
// NIfTI-1 and NIfTI-2 (headers of the NIfTI Data Format Working Group) in one file or
// as a pair .hdr and .img, packed by gzip or not, in either byte order; and Analyze 7.5.
//
// The place is that of `sform` where its code is above 0 and it is regular, else of `qform` where
// its code is above 0, else spacings alone with no orientation. Spaces are RAS; the unit is that of
// xyzt_units, millimetres if it says none. scl_slope 0 means that samples are not scaled.
//
// Analyze has no affine: its field `orient` says along which axes slices lie, and x runs to the
// patient's left (LAS for orient 0, as radiologists look at slices). Many programs left it 0 and
// wrote RAS; nobody can tell from the file. Its scales are not read.
#pragma once
#include <string>

#include "volume/format/stored_volume.h"

namespace wellspring::volume {

// Says whether a file's first four bytes are the size of a header of NIfTI or Analyze.
bool is_nifti(std::string_view first_bytes);

// Reads the header of a .nii or .hdr, or that beside an .img. Throws LoadError.
StoredVolume read_nifti_header(const std::string& file);

}  // namespace wellspring::volume
