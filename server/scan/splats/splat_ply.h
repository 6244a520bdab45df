// SPDX-License-Identifier: Apache-2.0
// Reads Gaussian splats of PLY files: as the reference's training writes them (f_dc, f_rest,
// opacity, scale, rot), and compressed by PlayCanvas in chunks of 256.
#pragma once
#include <string>

#include "scan/splats/splat_set.h"

namespace wellspring::scan {

// Throws LoadError. finish_splats() is up to the caller.
SplatSet read_splat_ply(const std::string& path);

}  // namespace wellspring::scan
