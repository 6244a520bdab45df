// SPDX-License-Identifier: Apache-2.0
// A bake to be gone on with.
#include "fuzz/cached.h"
#include "fuzz/lit_square.h"

namespace wellspring::fuzz {

void fuzz_cached_bake(Bytes bytes) {
  static const std::string file = folder().file("fuzz.bake");
  static const uint64_t format = [] {
    save_bake(baked_square().bake, file, cached_key);
    return format_of(file);
  }();
  replace_contents(file, format, bytes);
  read_bake_source(file);
  Bake bake;
  if (load_bake(baked_square().world, file, cached_key, bake) != KeyedFile::read) return;
  Bake shard = bake;
  merge_bake(shard, bake);
  finish_map(bake);
}

}  // namespace wellspring::fuzz
