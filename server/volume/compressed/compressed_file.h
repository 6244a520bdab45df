// SPDX-License-Identifier: Apache-2.0
// Files of compressed volumes, as compressed_volume.h describes them.
#pragma once
#include <string>

#include "base/layers.h"
#include "volume/compressed/compressed_volume.h"

namespace wellspring::volume {

// Maps the file: codes are read from disk when they are needed. Who replaces the file must rename
// another over it, as write_compressed() does. Throws LoadError.
CompressedVolume read_compressed(const std::string& path);
// Throws LoadError if the file cannot be written.
void write_compressed(const std::string& path, const CompressedVolume& volume);

}  // namespace wellspring::volume
