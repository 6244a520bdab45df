// SPDX-License-Identifier: Apache-2.0
// Makes graphs as TensorFlow.js stores them, a node at a time.
#pragma once
#include <sodium.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "unit/folder.h"

namespace wellspring::test {

struct MadeGraph {
  using json = nlohmann::json;

  json nodes = json::array(), weights = json::array(), signature;
  std::string bytes;

  // How TensorFlow writes attributes.
  static json text(const std::string& word) {
    std::string out(sodium_base64_ENCODED_LEN(word.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
    sodium_bin2base64(out.data(), out.size(), reinterpret_cast<const unsigned char*>(word.data()),
                      word.size(), sodium_base64_VARIANT_ORIGINAL);
    return out.c_str();
  }
  static json word(const std::string& word) { return {{"s", text(word)}}; }
  static json words(const std::vector<std::string>& all) {
    json list = json::array();
    for (const std::string& one : all) list.push_back(text(one));
    return {{"list", {{"s", list}}}};
  }
  static json whole(const std::vector<int>& numbers) {
    json list = json::array();
    for (int number : numbers) list.push_back(std::to_string(number));
    return {{"list", {{"i", list}}}};
  }

  MadeGraph& node(const std::string& name, const std::string& operation,
                  const std::vector<std::string>& inputs, json attributes = json::object()) {
    nodes.push_back(
        {{"name", name}, {"op", operation}, {"input", inputs}, {"attr", std::move(attributes)}});
    return *this;
  }
  // A picture, by rows, columns and channels.
  MadeGraph& picture(int rows, int columns, int channels) {
    json sizes = json::array();
    for (int size : {-1, rows, columns, channels})
      sizes.push_back({{"size", std::to_string(size)}});
    return node("in", "Placeholder", {},
                {{"dtype", {{"type", "DT_FLOAT"}}}, {"shape", {{"shape", {{"dim", sizes}}}}}});
  }
  MadeGraph& tensor(const std::string& name, const std::vector<int>& shape, const char* type) {
    weights.push_back({{"name", name}, {"shape", shape}, {"dtype", type}});
    return node(name, "Const", {});
  }
  MadeGraph& constant(const std::string& name, const std::vector<int>& shape,
                      const std::vector<float>& values) {
    for (float value : values) bytes.append(reinterpret_cast<const char*>(&value), 4);
    return tensor(name, shape, "float32");
  }
  MadeGraph& whole_constant(const std::string& name, const std::vector<int>& shape,
                            const std::vector<int>& values) {
    for (int value : values) bytes.append(reinterpret_cast<const char*>(&value), 4);
    return tensor(name, shape, "int32");
  }

  std::string json_text() const {
    json root = {{"modelTopology", {{"node", nodes}}},
                 {"weightsManifest", {{{"paths", {"net.bin"}}, {"weights", weights}}}}};
    if (!signature.is_null()) root["signature"] = signature;
    return root.dump();
  }
  // Writes both files; returns that of the graph.
  std::string write(const Folder& folder) const {
    folder.write("net.bin", bytes);
    return folder.write("net.json", json_text());
  }
};

// A small network: a convolution with a bias that halves a picture of 4x4 in two colours, the mean
// of three channels, and a matrix.
inline MadeGraph small_graph() {
  MadeGraph graph;
  std::vector<float> filter(2 * 2 * 2 * 3);
  for (size_t i = 0; i < filter.size(); i++) filter[i] = float(i % 5) - 2;
  graph.picture(4, 4, 2)
      .constant("filter", {2, 2, 2, 3}, filter)
      .constant("bias", {3}, {1, 2, 3})
      .node("conv", "_FusedConv2D", {"in", "filter", "bias"},
            {{"strides", MadeGraph::whole({1, 2, 2, 1})},
             {"padding", MadeGraph::word("SAME")},
             {"data_format", MadeGraph::word("NHWC")},
             {"fused_ops", MadeGraph::words({"BiasAdd", "Relu"})}})
      .whole_constant("axes", {2}, {1, 2})
      .node("mean", "Mean", {"conv", "axes"}, {{"keep_dims", {{"b", false}}}})
      .constant("matrix", {3, 2}, {1, 0, 0, 1, 1, 1})
      .node("product", "MatMul", {"mean", "matrix"})
      .node("out", "Identity", {"product:0"});
  graph.signature = {{"outputs", {{"result:0", {{"name", "out:0"}}}}}};
  return graph;
}

// Every operation that the small graph has not, on a picture of 6x6.
inline MadeGraph wide_graph() {
  using json = nlohmann::json;
  auto window = [](const char* padding, int stride, std::vector<std::string> ends = {}) {
    const json numbers = MadeGraph::whole({1, stride, stride, 1});
    json attributes = {
        {"strides", numbers}, {"ksize", numbers}, {"padding", MadeGraph::word(padding)}};
    if (!ends.empty()) attributes["fused_ops"] = MadeGraph::words(ends);
    return attributes;
  };
  MadeGraph graph;
  graph.picture(6, 6, 1)
      .constant("filter", {3, 3, 1, 2}, std::vector<float>(18, 0.1f))
      .constant("bias", {2}, {0.5f, -0.5f})
      .constant("slope", {1, 1, 2}, {0.1f, 0.2f})
      .node("deep", "FusedDepthwiseConv2dNative", {"in", "filter", "bias", "bias"},
            window("SAME", 2, {"BiasAdd", "Relu6"}))
      .node("plain", "Conv2D", {"in", "filter"}, window("SAME", 2))
      .node("other", "DepthwiseConv2dNative", {"in", "filter"}, window("SAME", 2))
      .node("bent", "Prelu", {"plain", "slope"})
      .node("product", "Mul", {"bent", "deep"})
      .node("sum", "AddN", {"product", "other", "bent"})
      .node("more", "Add", {"sum", "bias"})
      .node("pool", "MaxPool", {"more"}, window("SAME", 2))
      .whole_constant("rims", {4, 2}, {0, 0, 1, 0, 0, 1, 0, 0})
      .node("padded", "Pad", {"pool", "rims"})
      .node("steep", "Sigmoid", {"more"})
      .node("rest", "Relu", {"more"})
      .node("six", "Relu6", {"padded"})
      .whole_constant("axis", {}, {3})
      .node("both", "ConcatV2", {"steep", "six", "rest", "axis"})
      .whole_constant("row", {2}, {1, -1})
      .node("flat", "Reshape", {"both", "row"})
      .tensor("matrix", {54, 2}, "float32")
      .node("last", "_FusedMatMul", {"flat", "matrix", "bias"},
            {{"fused_ops", MadeGraph::words({"BiasAdd"})}, {"transpose_b", {{"b", false}}}})
      .node("out", "Softmax", {"last"});
  graph.weights.back()["quantization"] = {{"dtype", "uint8"}, {"scale", 0.01}, {"min", -1.0}};
  for (int i = 0; i < 108; i++) graph.bytes += char(i);
  return graph;
}

}  // namespace wellspring::test
