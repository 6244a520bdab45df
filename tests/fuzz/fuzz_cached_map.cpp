// SPDX-License-Identifier: Apache-2.0
// An illumination map kept from the last start.
#include "fuzz/cached.h"
#include "fuzz/lit_square.h"
#include "light/kept/binned_light.h"
#include "light/kept/map_file.h"

namespace wellspring::fuzz {

void fuzz_cached_map(Bytes bytes) {
  static const std::string file = folder().file("fuzz.maps");
  static const uint64_t format = [] {
    save_map(baked_square().world, *baked_square().map(1), file, cached_key);
    return format_of(file);
  }();
  replace_contents(file, format, bytes);
  const Scene& scene = baked_square().scene;
  const auto map = load_map(baked_square().world, file, cached_key).map;
  if (!map) return;
  mapped_objects(scene, *map);
  relit(*map, find_layer_colors(scene, LampLevels(scene.lamps.size(), 100)));
  const auto& charts = map->places->charts;
  for (size_t i = 0; i < std::min<size_t>(charts.size(), 8); i++)
    for (vec2 at : {vec2(0), vec2(0.5f), vec2(1e9f), vec2(-1)})
      eval_illumination(*map, charts[i], at);
}

}  // namespace wellspring::fuzz
