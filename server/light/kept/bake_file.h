// SPDX-License-Identifier: Apache-2.0
// Keeps a bake on disk, to be continued, finished, or merged with its other shards. A loaded bake
// has the same bits as the one that was saved.
#pragma once
#include <cstdint>
#include <string>

#include "base/write_file.h"
#include "light/kept/bake.h"

namespace wellspring::light {

// Returns a number that changes with everything that light depends on: what stands still, its
// materials and pictures, lights, lamps and environment. Takes tens of milliseconds.
uint64_t hash_scene(const Scene& scene);

// Returns false if the file cannot be written. `key`: hash_scene().
bool save_bake(const Bake& bake, const std::string& file, uint64_t key);
// Sets `bake` if the file was read. Never throws. Charts are found anew (seconds).
KeyedFile load_bake(const World& world, const std::string& file, uint64_t key, Bake& bake);

// Returns the folder of the exhibit that a bake was made of; empty: the file is no bake.
std::string read_bake_source(const std::string& file);

// Adds the tiles of `part`, another shard of the same bake, to those of `bake`. Returns false, and
// changes nothing, if `part` is no such shard or was added before.
bool merge_bake(const Bake& part, Bake& bake);

}  // namespace wellspring::light
