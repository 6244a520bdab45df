// SPDX-License-Identifier: Apache-2.0
// A finished illumination map as a file of some megabytes: what a package carries as light.maps,
// and what servers keep for their next start. Charts are found anew from the scene, so the file
// holds the nodes of their tiles alone: quantised (light in steps of 3 %, half a step off at most),
// told as the difference from what their neighbours let expect (the median edge detector of
// JPEG-LS: Weinberger, Seroussi, Sapiro 2000, "The LOCO-I Lossless Image Compression Algorithm",
// section III.A), and packed by zstd.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "base/write_file.h"
#include "light/sample/illumination_map.h"
#include "world/world.h"

namespace wellspring::light {

// `key`: hash_scene() (light/bake/bake_file.h) of the scene that `world` is of. False: the file
// cannot be written.
bool save_map(const World& world, const IlluminationMap& map, const std::string& file,
              uint64_t key);

// The file in an exhibit's folder.
inline std::string shipped_light(const std::string& folder) { return folder + "/light.maps"; }

// Whether there is one of the scene of that key, without taking it apart.
KeyedFile find_map(const std::string& file, uint64_t key);

struct LoadedMap {
  // Light of another scene (`found` is another_key) is taken where that scene's things stand as
  // they do here; of others the map knows nothing. Null: of nothing.
  std::shared_ptr<const IlluminationMap> map;
  KeyedFile found = KeyedFile::missing;
};
// Reads strangers' files: of one that is damaged, cut off or of another format there is no map, and
// no more memory is taken than for most_map_nodes. Never throws but Cancelled. Some tenths of a
// second.
inline constexpr size_t most_map_nodes = size_t(1) << 23;
LoadedMap load_map(const World& world, const std::string& file, uint64_t key);

}  // namespace wellspring::light
