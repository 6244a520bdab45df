// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/draw_shown.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "base/parallel.h"

namespace wellspring::scan {
namespace {

constexpr float most_code = 32767, brightest = 64;

vec3 coefficient(const SplatSet& set, size_t i, int k) {
  const vec3 value = k == 0
                         ? set.color[i]
                         : set.harmonics[i * size_t(splat_harmonics[set.degree]) + size_t(k - 1)];
  return glm::clamp(value, -brightest, brightest);
}

void fill_block(ShownSplats& shown, size_t at, const SplatSet& set, std::span<const uint32_t> which,
                vec3 middle) {
  SplatBlock& block = shown.blocks[at];
  const int used = int(which.size()), coefficients = shown.coefficients();
  for (int lane = 0; lane < lane_count; lane++) {
    const size_t i = which[size_t(std::min(lane, used - 1))];
    const quat q = set.turn[i];
    const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const bool turned = length > 1e-12f && std::isfinite(length);
    block.place.set(lane, set.place[i] - middle);
    block.scale.set(lane, glm::abs(set.scale[i]));
    block.turn_x[lane] = turned ? q.x / length : 0;
    block.turn_y[lane] = turned ? q.y / length : 0;
    block.turn_z[lane] = turned ? q.z / length : 0;
    block.turn_w[lane] = turned ? q.w / length : 1;
    block.opacity[lane] = lane < used ? glm::clamp(set.opacity[i], 0.0f, 1.0f) : 0;
  }
  float largest[2] = {1e-20f, 1e-20f};
  for (uint32_t i : which)
    for (int k = 0; k < coefficients; k++)
      largest[k != 0] = glm::max(largest[k != 0], max_component(glm::abs(coefficient(set, i, k))));
  block.color_scale = largest[0] / most_code;
  block.harmonics_scale = largest[1] / most_code;
  int16_t* code = shown.codes.data() + at * size_t(coefficients) * 3 * lane_count;
  for (int k = 0; k < coefficients; k++) {
    const float scale = most_code / largest[k != 0];
    for (int channel = 0; channel < 3; channel++)
      for (int lane = 0; lane < lane_count; lane++)
        *code++ = int16_t(std::lrint(
            coefficient(set, which[size_t(std::min(lane, used - 1))], k)[channel] * scale));
  }
}

// Returns whether a part of the box is where all of the planes are positive.
bool in_sight(const SplatNode& node, const LocalView& view) {
  const vec3 low = node.low - view.eye, high = node.high - view.eye;
  const auto most = [&](vec3 n) {
    return (n.x > 0 ? high.x : low.x) * n.x + (n.y > 0 ? high.y : low.y) * n.y +
           (n.z > 0 ? high.z : low.z) * n.z;
  };
  for (const ScanCut& cut : view.cuts)
    if (most(cut.normal) < cut.offset - dot(cut.normal, view.eye)) return false;
  // Comparisons let through what is not a number.
  return !(most(view.forward) < view.near) &&
         !(most(view.right - view.side.x * view.forward) < 0) &&
         !(most(view.side.y * view.forward - view.right) < 0) &&
         !(most(view.up + view.side.w * view.forward) < 0) &&
         !(most(-view.side.z * view.forward - view.up) < 0);
}

// Returns pixels that a cell is large where the node is nearest to the eye.
float cell_size(const SplatNode& node, const LocalView& view) {
  const vec3 away = glm::max(glm::max(node.low - view.eye, view.eye - node.high), 0.0f);
  return node.cell * view.focal / glm::max(glm::length(away), view.near);
}

struct Candidate {
  float size;
  uint32_t set, node;
  bool operator<(const Candidate& other) const {
    if (size != other.size) return size < other.size;
    return set != other.set ? set > other.set : node > other.node;
  }
};

}  // namespace

ShownSplats make_shown_splats(const SplatSet& set) {
  ShownSplats shown;
  SplatTree tree = make_splat_tree(set);
  shown.degree = set.degree;
  shown.middle = tree.middle;
  shown.nodes = tree.nodes;
  uint32_t blocks = 0;
  for (SplatNode& node : shown.nodes) {
    node.first = blocks;
    blocks += (node.count + lane_count - 1) / lane_count;
  }
  shown.blocks.resize(blocks);
  shown.codes.resize(size_t(blocks) * size_t(shown.coefficients()) * 3 * lane_count);
  parallel_for(int(shown.nodes.size()), [&](int n) {
    const SplatNode& from = tree.nodes[size_t(n)];
    const bool leaf = from.child_count == 0;
    std::vector<uint32_t> which(from.count);
    for (uint32_t i = 0; i < from.count; i++) which[i] = leaf ? tree.order[from.first + i] : i;
    for (uint32_t begin = 0; begin < from.count; begin += lane_count)
      fill_block(shown, shown.nodes[size_t(n)].first + begin / lane_count,
                 leaf ? set : tree.merged[size_t(n)],
                 std::span(which).subspan(begin, std::min<size_t>(lane_count, from.count - begin)),
                 leaf ? tree.middle : vec3(0));
  });
  return shown;
}

LocalView make_local_view(const PlacedSplats& set, const ScanCamera& view) {
  LocalView local;
  const glm::dquat back = glm::conjugate(glm::normalize(glm::dquat(set.turn)));
  local.eye = vec3(back * (view.eye - set.shift) / set.scale - dvec3(set.splats->middle));
  local.right = vec3(back * dvec3(view.right));
  local.up = vec3(back * dvec3(view.up));
  local.forward = vec3(back * dvec3(view.forward));
  local.scale = float(set.scale);
  local.near = glm::max(view.near, nearest_splat) / local.scale;
  local.focal = view.focal();
  const vec2 axis = view.axis_place();
  local.axis = axis - view.offset;
  // A few pixels around the picture belong to it, since splats are wider than their places.
  constexpr float around = 8;
  local.side = vec4(-around - axis.x, float(view.width) + around - axis.x, -around - axis.y,
                    float(view.height) + around - axis.y) /
               local.focal;
  for (const ScanCut& cut : set.cuts) {
    const vec3 normal = vec3(back * dvec3(cut.normal));
    const double offset = (double(cut.offset) - glm::dot(dvec3(cut.normal), set.shift)) / set.scale;
    local.cuts.push_back({normal, float(offset) - dot(normal, set.splats->middle)});
  }
  return local;
}

std::vector<ChosenSplats> choose_splats(std::span<const PlacedSplats> sets,
                                        std::span<const LocalView> views, float cell_pixels,
                                        int64_t budget) {
  std::vector<ChosenSplats> chosen;
  std::priority_queue<Candidate> open;
  int64_t total = 0;
  const auto add = [&](uint32_t set, uint32_t at) {
    const SplatNode& node = sets[set].splats->nodes[at];
    if (!in_sight(node, views[set])) return;
    total += node.count;
    if (node.child_count == 0) chosen.push_back({set, at});
    else open.push({cell_size(node, views[set]), set, at});
  };
  for (uint32_t s = 0; s < sets.size(); s++)
    if (!sets[s].splats->nodes.empty()) add(s, 0);
  while (!open.empty()) {
    const Candidate top = open.top();
    open.pop();
    const SplatNode& node = sets[top.set].splats->nodes[top.node];
    int64_t below = 0;
    const std::vector<SplatNode>& nodes = sets[top.set].splats->nodes;
    for (uint32_t c = node.first_child; c < node.first_child + node.child_count; c++)
      if (in_sight(nodes[c], views[top.set])) below += nodes[c].count;
    if (top.size <= cell_pixels || total - node.count + below > budget) {
      chosen.push_back({top.set, top.node});
      continue;
    }
    total -= node.count;
    for (uint32_t c = node.first_child; c < node.first_child + node.child_count; c++)
      add(top.set, c);
  }
  return chosen;
}

}  // namespace wellspring::scan
