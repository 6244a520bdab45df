// SPDX-License-Identifier: Apache-2.0
// Turns a graph into the layers that OpenCV's module dnn has, node by node; graph_network.cpp makes
// a network of them. Values of four dimensions are kept in OpenCV's order (picture, channel, row,
// column), others in TensorFlow's; `shape` is always TensorFlow's. All shapes are checked here, so
// that OpenCV is asked for nothing that it cannot do.
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "kiosk/network/graph/graph_file.h"

namespace wellspring::kiosk {

// Describes a layer of OpenCV with its parameters.
struct GraphLayer {
  std::string type;
  std::map<std::string, std::vector<int>> numbers{};
  std::map<std::string, std::string> words{};
  std::vector<WeightTensor> blobs{};
  std::vector<int> inputs{};  // layers: 0 is the picture, layer k stands at k - 1 of the plan
};

// Says where the values of a node are, and how many.
struct GraphValue {
  int layer = -1;  // -1: it is a constant
  std::vector<int> shape;
  const WeightTensor* constant = nullptr;
};

class GraphBuilder {
 public:
  explicit GraphBuilder(const Graph& graph) : graph_(graph) {}
  // Adds the graph's next node. Throws LoadError with the node.
  void add_node(const GraphNode& node);
  // Adds a layer that has the node's values in TensorFlow's order; returns its number.
  int add_output(size_t node);

  std::vector<GraphLayer> layers;
  std::vector<int> input_shape;    // empty until the placeholder is added
  std::vector<GraphValue> values;  // by node

 private:
  // Holds how wide a rim a window needs around a picture, in rows and columns, and how often it
  // then fits.
  struct Rim {
    int before[2] = {0, 0}, after[2] = {0, 0}, times[2] = {0, 0};
  };

  [[noreturn]] void refuse(const std::string& what) const;
  int add(GraphLayer layer);
  GraphValue add(GraphLayer layer, const GraphValue& from, std::vector<int> shape);
  int reordered(int from, const std::vector<int>& order);
  int reshaped(int from, const std::vector<int>& shape);
  int natural(const GraphValue& value);
  void check_shape(const std::vector<int>& shape);
  void count_work(const std::vector<int>& shape, double each);

  size_t count_inputs(size_t least, size_t most) const;
  const GraphValue& computed(size_t input, size_t dimensions = 0) const;
  const WeightTensor& constant(size_t input) const;
  std::vector<int> whole_numbers(size_t input) const;
  WeightTensor channel_numbers(const WeightTensor& tensor, int channels) const;
  const GraphAttribute* attribute(const std::string& name) const;
  bool flag(const std::string& name) const;
  std::array<int, 2> window(const std::string& name) const;
  Rim rim(const GraphValue& from, const std::array<int, 2>& size, const std::array<int, 2>& stride,
          const std::array<int, 2>& dilation) const;

  GraphValue placeholder();
  GraphValue convolution(bool depthwise, bool fused);
  GraphValue multiplied(bool fused);
  std::vector<std::string> add_bias(GraphLayer& layer, bool fused, int channels) const;
  GraphValue fused_end(GraphValue value, const std::vector<std::string>& ends);
  GraphValue prelu(const GraphValue& from, const WeightTensor& slopes);
  GraphValue joined(const char* operation);
  GraphValue max_pool();
  GraphValue mean();
  GraphValue pad();
  GraphValue reshape();
  GraphValue reshaped_value(const GraphValue& from, const std::vector<int>& shape);
  GraphValue with_dimension();
  GraphValue without_dimensions(const std::vector<double>& which);
  GraphValue cast();
  GraphValue resized();
  GraphValue concatenated();
  GraphValue softmax();

  const Graph& graph_;
  const GraphNode* node_ = nullptr;  // the one that is being added
  double multiplications_ = 0, numbers_ = 0;
};

}  // namespace wellspring::kiosk
