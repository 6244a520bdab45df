// SPDX-License-Identifier: Apache-2.0
#include "light/bake/filter_nodes.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/bake/beside.h"

namespace wellspring {
namespace {

constexpr float least_spread = 0.02f;  // of the mean around: light is never known to be evener

struct Noisy {
  std::vector<float> light, variance;  // of each node; variance below 0: nothing is known
};

Noisy measure(const BakeField& field, std::span<const uint8_t> leaks) {
  Noisy nodes{std::vector<float>(field.nodes(), 0), std::vector<float>(field.nodes(), -1)};
  for (size_t i = 0; i < field.nodes(); i++) {
    const float n = field.count[i];
    if (!(n > 1) || (!leaks.empty() && leaks[i])) continue;
    nodes.light[i] = float(field.mean_of(i));
    nodes.variance[i] = float(field.variance_of(i)) / (n - 1);
  }
  return nodes;
}

// The share of a node's own light that makes the least error, given those around.
float own_share(const IlluminationTile& tile, uint32_t i, const Noisy& nodes, float& mean,
                float& variance) {
  float sum = 0, squares = 0, noise = 0, count = 0;
  for_each_beside(tile, i, [&](uint32_t beside) {
    const size_t node = tile.first + beside;
    if (nodes.variance[node] < 0) return;
    sum += nodes.light[node], squares += nodes.light[node] * nodes.light[node];
    noise += nodes.variance[node], count++;
  });
  const float own = nodes.variance[tile.first + i];
  if (count < 2) return 1;
  mean = sum / count, noise /= count;
  float spread = std::max(squares / count - mean * mean - noise, 0.0f) +
                 least_spread * least_spread * mean * mean;
  float share = spread / (spread + own + 1e-20f);
  variance = share * share * own + (1 - share) * (1 - share) * noise / count;
  return share;
}

}  // namespace

NodeFilter make_node_filter(const BakeField& field, std::span<const uint8_t> leaks) {
  NodeFilter filter;
  Noisy nodes = measure(field, leaks), next = nodes;
  for (std::vector<float>& own : filter.own) {
    own.assign(field.nodes(), 1);
    parallel_for(int(field.tiles.size()), [&](int t) {
      const IlluminationTile& tile = field.tiles[size_t(t)];
      for (uint32_t i = 0; i < tile.nodes(); i++) {
        const size_t node = tile.first + i;
        if (nodes.variance[node] < 0) continue;
        float mean = nodes.light[node], variance = nodes.variance[node];
        own[node] = own_share(tile, i, nodes, mean, variance);
        next.light[node] = own[node] * nodes.light[node] + (1 - own[node]) * mean;
        next.variance[node] = variance;
      }
    });
    nodes = next;
  }
  double count = 0;
  for (size_t i = 0; i < field.nodes(); i++) {
    if (nodes.variance[i] < 0) continue;
    filter.variance += double(nodes.variance[i]), filter.light += double(nodes.light[i]), count++;
  }
  if (count > 0) filter.variance /= count, filter.light /= count;
  return filter;
}

void filter_nodes(const BakeField& field, const NodeFilter& filter, std::span<const uint8_t> known,
                  std::vector<vec3>& light) {
  std::vector<vec3> before;
  for (const std::vector<float>& own : filter.own) {
    before = light;
    parallel_for(int(field.tiles.size()), [&](int t) {
      const IlluminationTile& tile = field.tiles[size_t(t)];
      for (uint32_t i = 0; i < tile.nodes(); i++) {
        const size_t node = tile.first + i;
        if (!known[node] || own[node] >= 1) continue;
        vec3 sum(0);
        float count = 0;
        for_each_beside(tile, i, [&](uint32_t beside) {
          if (known[tile.first + beside] && field.count[tile.first + beside] > 1)
            sum += before[tile.first + beside], count++;
        });
        if (count > 0) light[node] = own[node] * before[node] + (1 - own[node]) / count * sum;
      }
    });
  }
}

}  // namespace wellspring
