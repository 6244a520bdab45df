// SPDX-License-Identifier: Apache-2.0
// Reads Gaussian splats of glTF 2.0 files: points with the extension KHR_gaussian_splatting, also
// packed by KHR_gaussian_splatting_compression_spz_2, where their nodes place them; and the early
// draft, whose attributes are _ROTATION, _SCALE and COLOR_0.
#pragma once
#include <string>

#include "scan/splats/splat_set.h"

namespace wellspring::scan {

// Throws LoadError. finish_splats() is up to the caller.
SplatSet read_splat_gltf(const std::string& path);

}  // namespace wellspring::scan
