// SPDX-License-Identifier: Apache-2.0
// Chooses the nodes of a tree of points that a picture shows: a cut through the tree.
#pragma once
#include <cstdint>
#include <vector>

#include "scan/camera.h"
#include "scan/tree/point_tree.h"

namespace wellspring::scan {

struct ChooseSettings {
  float pixels = 1;           // nodes are refined until points are no farther apart
  uint64_t budget = 2500000;  // points; more only if the root alone has more
  // Nodes that lie behind others as opaque as this are left out; 1: none is. Below 1 gaps may
  // appear, the more the lower it is: opacity is a mean over all directions.
  float threshold = 1;
};

struct ChosenNode {
  uint32_t node = 0;
  float pixels = 0;  // the spacing of its points as it appears at the node's nearest place
};

struct ChosenNodes {
  std::vector<ChosenNode> nodes;  // the nearest first
  uint64_t points = 0;
  uint64_t hidden = 0;  // points of nodes in the cut that lie behind opaque ones
};

// Refines the node with the largest spacing first, as long as the budget allows it. Leaves out what
// the frustum does not touch, or the view's cuts keep nothing of. Takes some microseconds a node;
// any thread. `view`: in the tree's frame.
ChosenNodes choose_nodes(const PointTree& tree, const ScanCamera& view,
                         const ChooseSettings& settings = {});

}  // namespace wellspring::scan
