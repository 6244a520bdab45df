// SPDX-License-Identifier: Apache-2.0
// Reads two formats of splats that browsers draw: .splat (antimatter15), 32 bytes a splat, and
// .ksplat (mkkellogg's GaussianSplats3D), sections of splats in buckets, at three levels of
// compression.
#pragma once
#include <string>
#include <string_view>

#include "scan/splats/splat_set.h"

namespace wellspring::scan {

// Throw LoadError. finish_splats() is up to the caller.
SplatSet read_splat(const std::string& file, std::string_view bytes);
SplatSet read_ksplat(const std::string& file, std::string_view bytes);

}  // namespace wellspring::scan
