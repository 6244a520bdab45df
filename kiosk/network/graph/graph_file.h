// SPDX-License-Identifier: Apache-2.0
// Reads trained networks as TensorFlow.js stores them ("graph model"): a file in JSON with the
// operations and a list of weights, and beside it files of their bytes. Nothing in them is trusted,
// and nothing is computed here: graph_network.h knows what operations mean.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "kiosk/network/weights.h"

namespace wellspring::kiosk {

// Holds what one attribute says, whichever of TensorFlow's ways it is written in: words (texts,
// types), or numbers (of any kind, true and false, the sizes of a shape). One value is a list of
// one; what is neither leaves both empty.
struct GraphAttribute {
  std::vector<std::string> words;
  std::vector<double> numbers;
};

struct GraphNode {
  std::string name, operation;
  std::string where;           // its place in the file with its name, for messages
  std::vector<size_t> inputs;  // nodes, all before this one
  std::map<std::string, GraphAttribute> attributes;
};

struct Graph {
  std::string file;
  std::vector<GraphNode> nodes;  // those that outputs need, each after its inputs
  Tensors constants;             // by the name of a node
  // Nodes by the names that the file's signature gives to outputs, without ":0" at the end; where
  // there is no signature, each node but constants that is read by none, by its own name.
  std::map<std::string, size_t> outputs;
};

// Loads FILE and its weights, which lie in the same folder. `cut` names nodes that are the outputs
// instead of those of the signature, so that what comes after them is left out. Throws LoadError
// naming file and node or tensor: no JSON, a node without name or operation, a name twice, an input
// that is no node or no first output of one, a circle, a constant without weights. Bounds: 32 MiB
// of JSON, 10,000 nodes, 64 MiB of weights.
Graph load_graph(const std::string& file, const std::vector<std::string>& cut = {});

}  // namespace wellspring::kiosk
