// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/splat_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "base/parallel.h"

namespace wellspring::scan {
namespace {

struct CellSplat {
  glm::ivec3 cell;
  bool large;
  uint32_t number;
  auto key() const { return std::make_tuple(cell.z, cell.y, cell.x, large); }
};

// Returns about how much of a picture an ellipsoid covers, as seen from all sides.
double covered_area(dvec3 s) { return s.x * s.y + s.y * s.z + s.z * s.x; }

// Turns a symmetric matrix to its axes by Jacobi's rotations; the columns of `axes` become them,
// and the result is the spreads along them.
dvec3 main_axes(glm::dmat3 m, glm::dmat3& axes) {
  axes = glm::dmat3(1);
  for (int round = 0; round < 12; round++)
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (std::abs(m[p][q]) <= 1e-300) continue;
        const double theta = 0.5 * std::atan2(2 * m[p][q], m[q][q] - m[p][p]);
        const double c = std::cos(theta), s = std::sin(theta);
        glm::dmat3 turn(1);
        turn[p][p] = c, turn[q][q] = c, turn[q][p] = s, turn[p][q] = -s;
        m = glm::transpose(turn) * m * turn;
        axes = axes * turn;
      }
  return glm::sqrt(glm::max(dvec3(m[0][0], m[1][1], m[2][2]), 0.0));
}

glm::dmat3 covariance(const SplatSet& set, size_t i) {
  const glm::dquat turn(glm::normalize(glm::dquat(set.turn[i])));
  glm::dmat3 axes = glm::mat3_cast(turn);
  for (int k = 0; k < 3; k++) axes[k] *= double(set.scale[i][k]);
  return axes * glm::transpose(axes);
}

// Opacity and size of what is merged follow from what it covers: where it cannot be more opaque it
// grows, so that as much light is stopped as by all of its splats.
void append_merged(SplatSet& out, const SplatSet& set, std::span<const CellSplat> group) {
  const size_t count = size_t(splat_harmonics[set.degree]);
  double sum = 0, covered = 0;
  dvec3 mean(0), color(0);
  dvec3 harmonics[splat_harmonics[3]] = {};
  const auto weight = [&](size_t i) {
    return double(set.opacity[i]) * (covered_area(dvec3(set.scale[i])) + 1e-30);
  };
  for (const CellSplat& s : group) {
    const size_t i = s.number;
    const double w = weight(i);
    sum += w;
    covered += double(set.opacity[i]) * covered_area(dvec3(set.scale[i]));
    mean += w * dvec3(set.place[i]);
    color += w * dvec3(set.color[i]);
    for (size_t k = 0; k < count; k++) harmonics[k] += w * dvec3(set.harmonics[i * count + k]);
  }
  mean /= sum;
  glm::dmat3 spread(0);
  for (const CellSplat& s : group) {
    const dvec3 away = dvec3(set.place[s.number]) - mean;
    spread +=
        (weight(s.number) / sum) * (covariance(set, s.number) + glm::outerProduct(away, away));
  }
  glm::dmat3 axes;
  dvec3 scale = main_axes(spread, axes);
  const double area = covered_area(scale);
  double opacity = area > 0 ? covered / area : 1;
  if (opacity > 1) {
    scale *= std::sqrt(std::min(opacity, 2.0));
    opacity = 1;
  }
  if (glm::determinant(axes) < 0) axes[2] = -axes[2];
  out.place.push_back(vec3(mean));
  out.scale.push_back(vec3(scale));
  out.turn.push_back(quat(glm::normalize(glm::quat_cast(axes))));
  out.opacity.push_back(float(opacity));
  out.color.push_back(vec3(color / sum));
  for (size_t k = 0; k < count; k++) out.harmonics.push_back(vec3(harmonics[k] / sum));
}

// Appends splat `i` of `from`, its place minus `middle`. Both have the same degree.
void append_splat(SplatSet& set, const SplatSet& from, size_t i, vec3 middle) {
  const size_t count = size_t(splat_harmonics[from.degree]);
  set.place.push_back(from.place[i] - middle);
  set.scale.push_back(glm::abs(from.scale[i]));
  const float length = glm::length(from.turn[i]);
  set.turn.push_back(length > 1e-12f ? from.turn[i] / length : quat(1, 0, 0, 0));
  set.opacity.push_back(glm::min(from.opacity[i], 1.0f));
  set.color.push_back(from.color[i]);
  const vec3* harmonics = from.harmonics.data() + i * count;
  set.harmonics.insert(set.harmonics.end(), harmonics, harmonics + count);
}

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

SplatSet merge_in_cells(const SplatSet& set, float cell) {
  std::vector<CellSplat> cells(set.size());
  for (size_t i = 0; i < set.size(); i++)
    cells[i] = {glm::ivec3(glm::clamp(glm::floor(set.place[i] / cell), -2e9f, 2e9f)),
                max_component(set.scale[i]) > cell, uint32_t(i)};
  std::stable_sort(cells.begin(), cells.end(),
                   [](const CellSplat& a, const CellSplat& b) { return a.key() < b.key(); });
  SplatSet merged;
  merged.degree = set.degree;
  for (size_t begin = 0, end; begin < cells.size(); begin = end) {
    for (end = begin + 1; end < cells.size() && cells[end].key() == cells[begin].key();) end++;
    const std::span<const CellSplat> group(cells.data() + begin, end - begin);
    if (group.size() == 1) append_splat(merged, set, group[0].number, vec3(0));
    else append_merged(merged, set, group);
  }
  return merged;
}

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
