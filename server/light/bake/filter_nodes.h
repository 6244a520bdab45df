// SPDX-License-Identifier: Apache-2.0
// Noise of a bake's nodes, filtered as far as their samples say that it is noise: the local Wiener
// filter (Lee 1980, "Digital Image Enhancement and Noise Filtering by Use of Local Statistics").
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/bake/bake_field.h"

namespace wellspring {

// What to make of each node's mean: `own` of it, the rest from the nodes around in its tile. The
// same for all layers.
struct NodeFilter {
  std::vector<float> own[2];  // of either round; 1: it stays
  double variance = 0;        // of the filtered luminance, mean over the nodes
  double light = 0;           // mean luminance
};
// `leaks`: nodes that do not count (light/bake/unseen.h).
NodeFilter make_node_filter(const BakeField& field, std::span<const uint8_t> leaks);
// Nodes that are not `known` neither change nor count.
void filter_nodes(const BakeField& field, const NodeFilter& filter, std::span<const uint8_t> known,
                  std::vector<vec3>& light);

}  // namespace wellspring
