// SPDX-License-Identifier: Apache-2.0
// A radiance grid kept from the last start.
#include "fuzz/cached.h"
#include "light/known/radiance_grid_file.h"

namespace wellspring::fuzz {

void fuzz_cached_grid(Bytes bytes) {
  static const std::string file = folder().file("fuzz.grid");
  static const uint64_t format = [] {
    save_radiance_grid({}, file, cached_key);
    return format_of(file);
  }();
  replace_contents(file, format, bytes);
  const auto grid = load_radiance_grid(file, cached_key);
  if (!grid) return;
  find_grid_slot(*grid, vec3(0.1f, 0.2f, 0.3f), vec3(0, 1, 0));
  if (grid->lamps) find_lamps_seen(*grid->lamps, vec3(0.1f, 0.2f, 0.3f), vec3(0, 1, 0));
  if (grid->parts) relit(*grid, LampLevels(grid->parts->light.size(), 100));
}

}  // namespace wellspring::fuzz
