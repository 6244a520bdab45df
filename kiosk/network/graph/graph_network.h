// SPDX-License-Identifier: Apache-2.0
// Runs any graph of known operations in OpenCV's module dnn. Outputs equal those of TensorFlow.js
// within 1e-3 (tests/unit/kiosk/network/graph). Known operations, all of 32-bit floats:
//   Placeholder (one picture; of whole numbers, too), Const, Identity, Cast to floats, Pad (with
//   zeros), ConcatV2, Reshape, ExpandDims, Squeeze, Unpack of one value
//   Conv2D, DepthwiseConv2dNative, MatMul, by constants; their forms that begin with _Fused or
//   Fused add a bias and end in Relu, Relu6 or Prelu
//   Add, AddV2, AddN, Mul: two values of one shape, or one and a constant for each channel; Sub: a
//   value less such a constant
//   Relu, Relu6, Prelu, Sigmoid, Softmax (over the last dimension)
//   MaxPool; Mean over rows and columns; ResizeBilinear with half_pixel_centers
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kiosk/network/graph/graph_file.h"

namespace wellspring::kiosk {

class GraphNetwork {
 public:
  // Makes the network and runs it once. Throws LoadError naming file and node: an operation or a
  // form of it that is not known, shapes that do not fit, or more work than 4e9 multiplications or
  // 256 MiB of values.
  explicit GraphNetwork(const Graph& graph);
  GraphNetwork(GraphNetwork&&) noexcept;
  ~GraphNetwork();

  // Size of the picture; with a value of channel c, row y and column x at (c * rows + y) * columns
  // + x (planes), which is OpenCV's order and not TensorFlow's.
  struct Input {
    int rows = 0, columns = 0, channels = 0;
  };
  const Input& input() const;
  // Runs the network, one thread at a time. Outputs have their names, and TensorFlow's order: the
  // last dimension (channels) changes fastest. Throws std::invalid_argument unless there is a value
  // for each of input().
  Tensors run(std::span<const float> planes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Loads FILE (graph_file.h) and makes its network.
GraphNetwork open_graph(const std::string& file);

}  // namespace wellspring::kiosk
