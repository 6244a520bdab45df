// SPDX-License-Identifier: Apache-2.0
// Opens a volume's file.
#pragma once
#include <string>

#include "volume/volume.h"

namespace wellspring::volume {

// Reads an NRRD whose raw samples follow its header in the same file. Throws LoadError.
Volume open_volume(const std::string& path);

}  // namespace wellspring::volume
