// SPDX-License-Identifier: Apache-2.0
// A finished illumination map on disk, for the next start of an exhibit.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "light/sample/illumination_map.h"
#include "world/scene.h"

namespace wellspring {

// `key`: hash_scene() (light/bake/bake_file.h). False: the file cannot be written.
bool save_map(const IlluminationMap& map, const std::string& file, uint64_t key);
// Null where the file is missing, damaged or of another scene. Never throws.
std::shared_ptr<const IlluminationMap> load_map(const Scene& scene, const std::string& file,
                                                uint64_t key);

}  // namespace wellspring
