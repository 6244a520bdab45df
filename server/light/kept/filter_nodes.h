// SPDX-License-Identifier: Apache-2.0
// Filters the noise of a bake's nodes along the surface as far as their samples say that it is
// noise: anisotropic diffusion (Perona and Malik 1990, "Scale-Space and Edge Detection Using
// Anisotropic Diffusion", eq. 7 and 8) whose edges are found by the nodes' own variance. Another
// node gets all light that a node gives, so no light is lost: rare bright samples are spread, not
// taken for errors.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "light/kept/bake_field.h"
#include "light/sample/illumination_map.h"

namespace wellspring::light {

// Visits the nodes beside a node, in its tile.

// Calls visit(node beside) for the up to eight nodes around node `i` of the tile.
template <class Visit>
void for_each_beside(const IlluminationTile& tile, uint32_t i, const Visit& visit) {
  const int columns = tile.columns + 1, rows = tile.rows + 1;
  const int x = int(i) % columns, y = int(i) / columns;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, rows - 1); row++)
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, columns - 1); column++)
      if (row != y || column != x) visit(uint32_t(row * columns + column));
}

// Holds how much light passes between nodes side by side, the same for all layers.
struct NodeFilter {
  static constexpr int rounds = 6;
  // Each round and node lists the four neighbours that come later in the tile: the next one, and
  // the three of the next row. 255 is as much as may pass.
  std::array<std::vector<std::array<uint8_t, 4>>, rounds> passes;
};
// Makes a filter from a field's samples. `leaks`: nodes that do not count
// (light/kept/filter_nodes.h).
NodeFilter make_node_filter(const BakeField& field, std::span<const uint8_t> leaks);
// Filters `light`. Nodes that are not `known` neither change nor count.
void filter_nodes(const BakeField& field, const NodeFilter& filter, std::span<const uint8_t> known,
                  std::vector<vec3>& light);

// Finds parts of surfaces that no eye can see, because they lie beyond another surface that passes
// through theirs: a rib goes on above the vault, a floor below the wall. Light there differs, and
// must not leak into visible places beside it.

// Says whether a node is seen; sight_unknown is 0: eyes were not looked for yet.
enum NodeSight : uint8_t { sight_unknown, sight_seen, sight_unseen };

// Returns for each node whether its light is to be taken from its neighbours (not 0): no eye sees
// it while one sees a neighbour whose light is very different, or it stands for parts of both.
// `eyes`: scene coordinates; without any, all nodes count as seen. `sight`: kept from call to call,
// of the same field.
std::vector<uint8_t> find_leaks(const World& world, const BakeCharts& charts,
                                std::span<const TilePlace> places, std::span<const vec3> eyes,
                                const BakeField& field, std::vector<uint8_t>& sight);

}  // namespace wellspring::light
