// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/draw_nodes.h"

#include <algorithm>
#include <queue>

namespace wellspring::scan {
namespace {

// Returns whether a part of the box is where all of the planes are positive.
bool in_sight(const SplatNode& node, const LocalView& view) {
  const vec3 low = node.low - view.eye, high = node.high - view.eye;
  const auto most = [&](vec3 n) {
    return (n.x > 0 ? high.x : low.x) * n.x + (n.y > 0 ? high.y : low.y) * n.y +
           (n.z > 0 ? high.z : low.z) * n.z;
  };
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
  local.axis = view.axis_place() - view.offset;
  // A few pixels around the picture belong to it, since splats are wider than their places.
  constexpr float around = 8;
  const vec2 axis = view.axis_place();
  local.side = vec4(-around - axis.x, float(view.width) + around - axis.x, -around - axis.y,
                    float(view.height) + around - axis.y) /
               local.focal;
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
