// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/graph/graph_network.h"

#include <algorithm>
#include <opencv2/dnn.hpp>
#include <stdexcept>
#include <utility>

#include "base/load_error.h"
#include "kiosk/network/graph/graph_builder.h"

namespace wellspring::kiosk {

struct GraphNetwork::Impl {
  cv::dnn::Net net;
  Input input;
  // These are by output.
  std::vector<std::string> names;
  std::vector<std::vector<int>> shapes;
  std::vector<cv::String> layers;
};

// Adds the layer behind those that are there; returns its name.
static std::string add_to(cv::dnn::Net& net, const GraphLayer& layer, int number) {
  using cv::dnn::DictValue;
  cv::dnn::LayerParams params;
  for (const auto& [name, numbers] : layer.numbers)
    if (numbers.size() == 1) params.set(name, numbers[0]);
    else params.set(name, DictValue::arrayInt(numbers.data(), int(numbers.size())));
  for (const auto& [name, word] : layer.words) params.set(name, word);
  for (const WeightTensor& tensor : layer.blobs) params.blobs.push_back(blob(tensor));
  const std::string name = layer.type + std::to_string(number);
  const int id = net.addLayer(name, layer.type, params);
  for (size_t i = 0; i < layer.inputs.size(); i++) net.connect(layer.inputs[i], 0, id, int(i));
  return name;
}

GraphNetwork::GraphNetwork(const Graph& graph) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  try {
    GraphBuilder builder(graph);
    for (const GraphNode& node : graph.nodes) builder.add_node(node);
    std::vector<int> outputs;
    for (const auto& [name, node] : graph.outputs) {
      outputs.push_back(builder.add_output(node));
      m.names.push_back(name);
      m.shapes.push_back(builder.values[node].shape);
    }
    const std::vector<int>& shape = builder.input_shape;
    if (shape.empty()) throw LoadError(graph.file, "", "the graph has no input");
    m.input = {shape[1], shape[2], shape[3]};
    std::vector<std::string> layers = {""};
    for (const GraphLayer& layer : builder.layers)
      layers.push_back(add_to(m.net, layer, int(layers.size())));
    for (int output : outputs) m.layers.push_back(layers[size_t(output)]);
    m.net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    m.net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    // OpenCV lays a network out when it runs first.
    run(std::vector<float>(size_t(shape[1]) * size_t(shape[2]) * size_t(shape[3])));
  } catch (const cv::Exception& error) {
    throw LoadError(graph.file, "", "OpenCV cannot run the graph: " + error.err);
  }
}
GraphNetwork::GraphNetwork(GraphNetwork&&) noexcept = default;
GraphNetwork::~GraphNetwork() = default;

const GraphNetwork::Input& GraphNetwork::input() const { return impl_->input; }

Tensors GraphNetwork::run(std::span<const float> planes) {
  const Input& size = impl_->input;
  cv::Mat in({1, size.channels, size.rows, size.columns}, CV_32F);
  if (planes.size() != in.total())
    throw std::invalid_argument("a network got a picture of another size");
  std::ranges::copy(planes, in.ptr<float>());
  impl_->net.setInput(in);
  std::vector<cv::Mat> results;
  impl_->net.forward(results, impl_->layers);
  Tensors outputs;
  for (size_t i = 0; i < results.size(); i++) {
    const auto* first = results[i].ptr<float>();
    outputs[impl_->names[i]] = {impl_->shapes[i], {first, first + results[i].total()}};
  }
  return outputs;
}

GraphNetwork open_graph(const std::string& file) { return GraphNetwork(load_graph(file)); }

}  // namespace wellspring::kiosk
