// SPDX-License-Identifier: Apache-2.0
// Noise of a bake's nodes, filtered along the surface as far as their samples say that it is noise:
// anisotropic diffusion (Perona and Malik 1990, "Scale-Space and Edge Detection Using Anisotropic
// Diffusion", eq. 7 and 8) whose edges are told by the nodes' own variance. What one node gives
// another gets, so no light is lost: rare bright samples are spread, not taken for errors.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "light/bake/bake_field.h"

namespace wellspring::light {

// How much light passes between nodes side by side, the same for all layers.
struct NodeFilter {
  static constexpr int rounds = 6;
  // Each round and node lists the four neighbours that come later in the tile: the next one, and
  // the three of the next row. 255 is as much as may pass.
  std::array<std::vector<std::array<uint8_t, 4>>, rounds> passes;
};
// `leaks`: nodes that do not count (light/bake/unseen.h).
NodeFilter make_node_filter(const BakeField& field, std::span<const uint8_t> leaks);
// Nodes that are not `known` neither change nor count.
void filter_nodes(const BakeField& field, const NodeFilter& filter, std::span<const uint8_t> known,
                  std::vector<vec3>& light);

}  // namespace wellspring::light
