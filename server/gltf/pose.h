// SPDX-License-Identifier: Apache-2.0
// Where every node stands at one moment: the node tree (glTF 2.0 section 3.5), animations (3.11,
// appendix C) and morph weights, in double precision.
#pragma once
#include "gltf/file.h"
#include "gltf/node.h"

namespace wellspring::gltf {

// All nodes of the file at `time` of its first animation; at 0 the rest pose. Throws LoadError for
// nodes with two parents, cycles, and animations that cannot be read.
std::vector<Node> make_pose(File& file, double time);

// All nodes that hang together without a cycle, each after its parent.
std::vector<uint32_t> parents_first(const std::vector<Node>& nodes);
// Finds Node::global of all, in that order, after any have been moved.
void place_nodes(const std::vector<uint32_t>& order, std::vector<Node>& nodes);

}  // namespace wellspring::gltf
