// SPDX-License-Identifier: Apache-2.0
// A radiance grid on disk, from one start of an exhibit to the next: walks that fill it take many
// seconds. Same bits as the one that was saved. One processor's files: numbers lie as in memory.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "light/sample/radiance_grid.h"

namespace wellspring {

// `key` says what the grid was made of. Null where the file is missing, damaged or of another key.
// Never throws.
std::shared_ptr<const RadianceGrid> load_radiance_grid(const std::string& file, uint64_t key);
// Replaces the file as a whole, and makes its folder. False: it cannot be written.
bool save_radiance_grid(const RadianceGrid& grid, const std::string& file, uint64_t key);

}  // namespace wellspring
