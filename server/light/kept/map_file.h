// SPDX-License-Identifier: Apache-2.0
// Keeps a finished illumination map as a file of some megabytes, which a package carries as
// light.maps, and servers keep for their next start. Charts are found anew from the scene, so the
// file holds the nodes of their tiles alone: quantised (light in steps of 3 %, half a step off at
// most), written as the difference from what their neighbours let expect (the median edge detector
// of JPEG-LS: Weinberger, Seroussi, Sapiro 2000, "The LOCO-I Lossless Image Compression Algorithm",
// section III.A), and packed by zstd.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "base/write_file.h"
#include "light/sample/illumination_map.h"
#include "world/world.h"

namespace wellspring::light {

// Writes a map; returns false if the file cannot be written. `key`: hash_scene()
// (light/kept/bake_file.h) of the scene of `world`.
bool save_map(const World& world, const IlluminationMap& map, const std::string& file,
              uint64_t key);

// Returns the path of the file in an exhibit's folder.
inline std::string shipped_light(const std::string& folder) { return folder + "/light.maps"; }

// Returns whether there is a map of the scene of that key, without unpacking it.
KeyedFile find_map(const std::string& file, uint64_t key);

struct LoadedMap {
  // A map of another scene (`found` is another_key) has light for the things that stand as they do
  // here, and none for others. Null: there is no light.
  std::shared_ptr<const IlluminationMap> map;
  KeyedFile found = KeyedFile::missing;
  std::vector<int> dark_lamps{};  // lamps of the scene whose light is not in the file
};
// Reads files of unknown origin: a file that is damaged, cut off or of another format gives no map,
// and no more memory is taken than for most_map_nodes. Never throws but Cancelled. Takes some
// tenths of a second.
inline constexpr size_t most_map_nodes = size_t(1) << 23;
LoadedMap load_map(const World& world, const std::string& file, uint64_t key);

}  // namespace wellspring::light
