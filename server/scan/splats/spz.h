// SPDX-License-Identifier: Apache-2.0
// Reads SPZ, Niantic's packed splats (github.com/nianticlabs/spz, "File Format"): versions 1 to 3
// are one stream of gzip, or lie open; version 4 has a stream of Zstandard a value.
#pragma once
#include <string>
#include <string_view>

#include "scan/splats/splat_set.h"

namespace wellspring::scan {

// `file` and `where` are for messages. Throws LoadError. finish_splats() is up to the caller.
SplatSet read_spz(const std::string& file, const std::string& where, std::string_view bytes);

// Says whether bytes begin as SPZ does, packed by gzip or not.
bool is_spz(std::string_view bytes);

}  // namespace wellspring::scan
