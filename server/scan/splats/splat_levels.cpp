// SPDX-License-Identifier: Apache-2.0
#include "scan/splats/splat_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "scan/splats/splat_merge.h"

namespace wellspring::scan {
namespace {

constexpr int tree_depth = 21;
constexpr uint32_t leaf_splats = 1024, most_merged = 4096;
constexpr float cells_a_side = 24;

struct KeyedSplat {
  uint64_t key;
  uint32_t number;
  bool operator<(const KeyedSplat& other) const {
    return key != other.key ? key < other.key : number < other.number;
  }
};

// Puts two zeros behind each of 21 bits.
uint64_t spread_bits(uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

bool can_be_drawn(const SplatSet& set, size_t i) {
  const quat q = set.turn[i];
  bool fine = is_finite(set.place[i]) && is_finite(set.scale[i]) && is_finite(set.color[i]) &&
              std::isfinite(q.x + q.y + q.z + q.w) && set.opacity[i] >= 1 / 255.0f &&
              std::isfinite(set.opacity[i]);
  const size_t count = size_t(splat_harmonics[set.degree]);
  for (size_t k = 0; fine && k < count; k++) fine = is_finite(set.harmonics[i * count + k]);
  return fine;
}

struct Cube {
  dvec3 low{0};
  double edge = 0;
};

// Splits a node's range of the sorted splats where their keys differ first.
void split_node(SplatTree& tree, std::vector<int>& depths, const std::vector<KeyedSplat>& sorted,
                uint32_t at) {
  const uint32_t first = tree.nodes[at].first, last = first + tree.nodes[at].count;
  if (last - first <= leaf_splats) return;
  const uint64_t differ = sorted[first].key ^ sorted[last - 1].key;
  if (differ == 0) return;
  const int depth = tree_depth - 1 - (63 - __builtin_clzll(differ)) / 3;
  const int shift = 3 * (tree_depth - 1 - depth);
  depths[at] = depth;
  tree.nodes[at].first_child = uint32_t(tree.nodes.size());
  for (uint32_t begin = first; begin < last;) {
    const uint64_t part = sorted[begin].key >> shift;
    const auto end =
        std::partition_point(sorted.begin() + begin, sorted.begin() + last,
                             [&](const KeyedSplat& k) { return k.key >> shift == part; });
    SplatNode child;
    child.first = begin;
    child.count = uint32_t(end - sorted.begin()) - begin;
    begin += child.count;
    tree.nodes.push_back(child);
    depths.push_back(depth + 1);
    tree.nodes[at].child_count++;
  }
}

void grow_box(SplatNode& node, vec3 place, vec3 scale) {
  const float reach = splat_reach * glm::max(scale.x, glm::max(scale.y, scale.z));
  node.low = glm::min(node.low, place - reach);
  node.high = glm::max(node.high, place + reach);
}

// Merges what a node's children show; in cells of twice the edge while there are too many.
void merge_children(SplatTree& tree, const SplatSet& set, uint32_t at, double edge) {
  SplatNode& node = tree.nodes[at];
  SplatSet all;
  all.degree = set.degree;
  for (uint32_t c = node.first_child; c < node.first_child + node.child_count; c++) {
    const SplatNode& child = tree.nodes[c];
    if (child.child_count != 0)
      for (uint32_t i = 0; i < child.count; i++) append_splat(all, tree.merged[c], i, vec3(0));
    else
      for (uint32_t i = child.first; i < child.first + child.count; i++)
        append_splat(all, set, tree.order[i], tree.middle);
    node.low = glm::min(node.low, child.low);
    node.high = glm::max(node.high, child.high);
  }
  float cell = float(edge) / cells_a_side;
  SplatSet merged = merge_in_cells(all, cell);
  while (merged.size() > most_merged) merged = merge_in_cells(all, cell *= 2);
  node.cell = cell;
  node.count = uint32_t(merged.size());
  for (size_t i = 0; i < merged.size(); i++) grow_box(node, merged.place[i], merged.scale[i]);
  tree.merged[at] = std::move(merged);
}

}  // namespace

SplatTree make_splat_tree(const SplatSet& set) {
  SplatTree tree;
  std::vector<KeyedSplat> sorted;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  dvec3 low(infinite), high(-infinite);
  for (size_t i = 0; i < set.size(); i++)
    if (can_be_drawn(set, i)) {
      sorted.push_back({0, uint32_t(i)});
      low = glm::min(low, dvec3(set.place[i]));
      high = glm::max(high, dvec3(set.place[i]));
    }
  if (sorted.empty()) return tree;
  const dvec3 size = high - low;
  const Cube cube{low, std::max({size.x, size.y, size.z, 1e-30})};
  tree.middle = vec3(0.5 * (low + high));
  parallel_ranges(int(sorted.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      const dvec3 part = (dvec3(set.place[sorted[size_t(i)].number]) - cube.low) / cube.edge;
      const glm::u64vec3 code(glm::clamp(part, 0.0, 1.0) * double((1 << tree_depth) - 1));
      sorted[size_t(i)].key =
          spread_bits(code.x) | spread_bits(code.y) << 1 | spread_bits(code.z) << 2;
    }
  });
  std::sort(sorted.begin(), sorted.end());
  tree.order.reserve(sorted.size());
  for (const KeyedSplat& k : sorted) tree.order.push_back(k.number);

  std::vector<int> depths{0};
  tree.nodes.resize(1);
  tree.nodes[0].count = uint32_t(sorted.size());
  for (uint32_t at = 0; at < tree.nodes.size(); at++) split_node(tree, depths, sorted, at);

  tree.merged.resize(tree.nodes.size());
  parallel_ranges(int(tree.nodes.size()), 16, [&](int begin, int end) {
    for (int at = begin; at < end; at++) {
      SplatNode& node = tree.nodes[size_t(at)];
      node.low = vec3(std::numeric_limits<float>::infinity());
      node.high = -node.low;
      if (node.child_count != 0) continue;
      for (uint32_t i = node.first; i < node.first + node.count; i++)
        grow_box(node, set.place[tree.order[i]] - tree.middle, set.scale[tree.order[i]]);
    }
  });
  for (int depth = *std::max_element(depths.begin(), depths.end()); depth >= 0; depth--) {
    std::vector<uint32_t> inner;
    for (uint32_t at = 0; at < tree.nodes.size(); at++)
      if (depths[at] == depth && tree.nodes[at].child_count != 0) inner.push_back(at);
    parallel_each(int(inner.size()), [&](int i) {
      merge_children(tree, set, inner[size_t(i)], std::ldexp(cube.edge, -depth));
    });
  }
  return tree;
}

}  // namespace wellspring::scan
