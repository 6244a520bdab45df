// SPDX-License-Identifier: Apache-2.0
#include "light/bake/unseen.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/bake/beside.h"
#include "light/random/sampler.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr float another_light = 1.6f;  // times as bright, beyond a floor
constexpr float floor_share = 0.15f;   // of the mean light
constexpr int places_a_node = 4;       // from which eyes are looked for
constexpr uint64_t look_seed = 0x6c6f6f6b;

bool is_seen(const World& world, const BakeCharts& charts, const BakeField& field,
             const TilePlace& at, uint32_t tile, uint32_t i, std::span<const vec3> eyes) {
  for (int k = 0; k < places_a_node; k++) {
    Sampler sampler(mix64(look_seed + (uint64_t(tile) << 32 | i)), uint32_t(k));
    float choice = sampler.next();
    NodePlace place = sample_node(world, charts, field, at, tile, i, choice, sampler.next2());
    if (!place.valid) continue;
    SurfacePlace surface;
    surface.position = place.ray.origin + place.ray.direction;
    surface.geometric_normal = -place.ray.direction;
    surface.extent = max_component(abs(surface.position));
    for (size_t e = 0; e < eyes.size(); e++) {
      vec3 eye = eyes[(e + i) % eyes.size()], line = eye - surface.position;
      if (!(dot(line, surface.geometric_normal) > 0)) continue;
      Ray ray;
      ray.origin = offset_origin(surface, line);
      ray.direction = eye - ray.origin;
      ray.t_max = 1;
      PanesPassed panes;
      if (!world.occluded(ray, panes)) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<uint8_t> find_leaks(const World& world, const BakeCharts& charts,
                                std::span<const TilePlace> places, std::span<const vec3> eyes,
                                const BakeField& field, std::vector<uint8_t>& sight) {
  std::vector<uint8_t> leaks(field.nodes(), 0);
  sight.resize(field.nodes(), sight_unknown);
  if (eyes.empty()) return leaks;
  std::vector<float> light(field.nodes(), -1);  // below 0: nothing is known
  double sum = 0, count = 0;
  for (size_t n = 0; n < field.nodes(); n++)
    if (field.count[n] > 0) light[n] = float(field.mean_of(n)), sum += double(light[n]), count++;
  const float floor = count > 0 ? floor_share * float(sum / count) : 0;
  auto differ = [&](float a, float b) {
    return a >= 0 && b >= 0 && std::max(a, b) + floor > another_light * (std::min(a, b) + floor);
  };
  parallel_for(int(field.tiles.size()), [&](int t) {
    const IlluminationTile& tile = field.tiles[size_t(t)];
    auto unseen = [&](uint32_t i) {
      uint8_t& known = sight[tile.first + i];
      if (known == sight_unknown)
        known = is_seen(world, charts, field, places[size_t(t)], uint32_t(t), i, eyes)
                    ? sight_seen
                    : sight_unseen;
      return known == sight_unseen;
    };
    for (uint32_t i = 0; i < tile.nodes(); i++)
      for_each_beside(tile, i, [&](uint32_t beside) {
        if (!leaks[tile.first + i] && differ(light[tile.first + i], light[tile.first + beside]) &&
            unseen(i) && !unseen(beside))
          leaks[tile.first + i] = 1;
      });
    // What hangs together with those and is not seen either is no better.
    for (bool more = true; more;) {
      more = false;
      for (uint32_t i = 0; i < tile.nodes(); i++)
        for_each_beside(tile, i, [&](uint32_t beside) {
          if (leaks[tile.first + i] || leaks[tile.first + beside] != 1) return;
          if (light[tile.first + i] < 0 || !unseen(i)) return;
          leaks[tile.first + i] = 1;
          more = true;
        });
    }
    // What lies next to those may stand for parts of both: then it is unlike what lies behind it.
    for (uint32_t i = 0; i < tile.nodes(); i++) {
      const size_t node = tile.first + i;
      if (leaks[node] || light[node] < 0) continue;
      bool near = false;
      for_each_beside(tile, i, [&](uint32_t b) { near |= leaks[tile.first + b] == 1; });
      if (!near) continue;
      float away = 0, others = 0;
      for_each_beside(tile, i, [&](uint32_t b) {
        bool clear = light[tile.first + b] >= 0 && leaks[tile.first + b] != 1;
        for_each_beside(tile, b, [&](uint32_t c) { clear &= leaks[tile.first + c] != 1; });
        if (clear) away += light[tile.first + b], others++;
      });
      if (others > 0 && differ(light[node], away / others)) leaks[node] = 2;
    }
  });
  return leaks;
}

}  // namespace wellspring::light
