// SPDX-License-Identifier: Apache-2.0
// A bake on disk, to be gone on with, finished, or merged with its other shards. Same bits as the
// one that was saved.
#pragma once
#include <cstdint>
#include <string>

#include "base/write_file.h"
#include "light/bake/bake.h"

namespace wellspring::light {

// Changes with everything that light depends on: what stands still, its materials and pictures,
// lights, lamps and environment. Tens of milliseconds.
uint64_t hash_scene(const Scene& scene);

// `key`: hash_scene(). False: the file cannot be written.
bool save_bake(const Bake& bake, const std::string& file, uint64_t key);
// Sets `bake` where the file was read. Never throws. Charts are found anew (seconds).
KeyedFile load_bake(const World& world, const std::string& file, uint64_t key, Bake& bake);

// The exhibit's folder that a bake was made of; empty: the file is none.
std::string read_bake_source(const std::string& file);

// The tiles of `part` are added to those of `bake`: another shard of the same bake. False: it is
// none, or one that is there already; nothing has changed.
bool merge_bake(const Bake& part, Bake& bake);

}  // namespace wellspring::light
