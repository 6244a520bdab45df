// SPDX-License-Identifier: Apache-2.0
#include "light/kept/filter_nodes.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/random/sampler.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

// Share that passes to each neighbour at most: all nine nodes become equal.
constexpr float most_passed = 1.0f / 9;
constexpr float edge_deviations = 2;  // deviations by which nodes differ if a third as much passes
constexpr float edge_share = 0.02f;   // share of two nodes' light that counts as noise in any case

struct Noisy {
  std::vector<float> light, variance;  // one for each node; variance below 0: unknown
};

// Calls visit(which of the four, neighbour) for the neighbours that come later in the tile.
template <class Visit>
void for_each_later(const IlluminationTile& tile, uint32_t i, const Visit& visit) {
  const uint32_t stride = tile.columns + 1u, x = i % stride, y = i / stride;
  if (x < tile.columns) visit(0, i + 1);
  if (y == tile.rows) return;
  if (x > 0) visit(1, i + stride - 1);
  visit(2, i + stride);
  if (x < tile.columns) visit(3, i + stride + 1);
}

// Averages variances over nodes side by side, which are about equally sure: a node whose few
// samples have missed something bright looks sure of being dark.
void pool_variances(const BakeField& field, Noisy& nodes) {
  const std::vector<float> own = nodes.variance;
  parallel_for(int(field.tiles.size()), [&](int t) {
    const IlluminationTile& tile = field.tiles[size_t(t)];
    for (uint32_t i = 0; i < tile.nodes(); i++) {
      const size_t node = tile.first + i;
      if (own[node] < 0) continue;
      float sum = own[node], count = 1;
      for_each_beside(tile, i, [&](uint32_t beside) {
        if (own[tile.first + beside] >= 0) sum += own[tile.first + beside], count++;
      });
      nodes.variance[node] = sum / count;
    }
  });
}

Noisy measure(const BakeField& field, std::span<const uint8_t> leaks) {
  Noisy nodes{std::vector<float>(field.nodes(), 0), std::vector<float>(field.nodes(), -1)};
  for (size_t i = 0; i < field.nodes(); i++) {
    const float n = field.count[i];
    if (!(n > 1) || (!leaks.empty() && leaks[i])) continue;
    nodes.light[i] = float(field.mean_of(i));
    nodes.variance[i] = float(field.variance_of(i)) / (n - 1);
  }
  pool_variances(field, nodes);
  return nodes;
}

uint8_t pass_between(const Noisy& nodes, size_t a, size_t b) {
  const float differ = nodes.light[a] - nodes.light[b],
              even = edge_share * (nodes.light[a] + nodes.light[b]),
              usual = edge_deviations * edge_deviations * (nodes.variance[a] + nodes.variance[b]) +
                      even * even;
  return usual > 0 ? uint8_t(std::lround(255 * std::exp(-differ * differ / usual))) : uint8_t(255);
}

float share_of(uint8_t pass) { return most_passed / 255 * float(pass); }

// Does one round of a tile's nodes, in which neighbours exchange light. Variances follow as if
// nodes had no correlation.
void diffuse_noise(const IlluminationTile& tile, std::span<const std::array<uint8_t, 4>> passes,
                   const Noisy& from, Noisy& to) {
  for (uint32_t i = 0; i < tile.nodes(); i++) {
    const size_t a = tile.first + i;
    if (from.variance[a] < 0) continue;
    for_each_later(tile, i, [&](int k, uint32_t later) {
      const size_t b = tile.first + later;
      const float share = share_of(passes[a][size_t(k)]);
      const float flow = share * (from.light[b] - from.light[a]);
      to.light[a] += flow, to.light[b] -= flow;
      to.variance[a] += share * share * from.variance[b] - share * 2 * from.variance[a] +
                        share * share * from.variance[a];
      to.variance[b] += share * share * from.variance[a] - share * 2 * from.variance[b] +
                        share * share * from.variance[b];
    });
  }
  for (uint32_t node = tile.first; node < tile.first + tile.nodes(); node++)
    if (from.variance[node] >= 0)
      to.variance[node] = std::max(to.variance[node], 0.04f * from.variance[node]);
}

}  // namespace

NodeFilter make_node_filter(const BakeField& field, std::span<const uint8_t> leaks) {
  NodeFilter filter;
  Noisy nodes = measure(field, leaks), next = nodes;
  for (auto& passes : filter.passes) {
    passes.assign(field.nodes(), {});
    parallel_for(int(field.tiles.size()), [&](int t) {
      const IlluminationTile& tile = field.tiles[size_t(t)];
      for (uint32_t i = 0; i < tile.nodes(); i++) {
        const size_t node = tile.first + i;
        if (nodes.variance[node] < 0) continue;
        for_each_later(tile, i, [&](int k, uint32_t later) {
          if (nodes.variance[tile.first + later] >= 0)
            passes[node][size_t(k)] = pass_between(nodes, node, tile.first + later);
        });
      }
      diffuse_noise(tile, passes, nodes, next);
    });
    nodes = next;
  }
  return filter;
}

void filter_nodes(const BakeField& field, const NodeFilter& filter, std::span<const uint8_t> known,
                  std::vector<vec3>& light) {
  std::vector<vec3> before;
  for (const auto& passes : filter.passes) {
    before = light;
    parallel_for(int(field.tiles.size()), [&](int t) {
      const IlluminationTile& tile = field.tiles[size_t(t)];
      for (uint32_t i = 0; i < tile.nodes(); i++) {
        const size_t a = tile.first + i;
        for_each_later(tile, i, [&](int k, uint32_t later) {
          const size_t b = tile.first + later;
          if (!known[a] || !known[b]) return;
          const vec3 flow = share_of(passes[a][size_t(k)]) * (before[b] - before[a]);
          light[a] += flow, light[b] -= flow;
        });
      }
    });
  }
}

namespace {

constexpr float another_light = 1.6f;  // times as bright, beyond a floor
// Share of the mean light that is added before light is compared.
constexpr float floor_share = 0.15f;
constexpr int places_a_node = 4;  // places of a node from which eyes are looked for
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
  std::vector<float> light(field.nodes(), -1);  // below 0: unknown
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
    // Unseen nodes beside leaks, and those beside them, leak as well.
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
    // A node beside a leak may stand for parts of both surfaces: then its light differs from that
    // of nodes farther from the leak.
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
