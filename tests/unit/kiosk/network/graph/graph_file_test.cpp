// SPDX-License-Identifier: Apache-2.0
// Graphs are read as they were written; damaged ones are refused, with the place of their fault.
#include "kiosk/network/graph/graph_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/load_error.h"
#include "base/rng.h"
#include "unit/kiosk/network/graph/made_graph.h"

namespace wellspring::test {
namespace {

struct GraphFile : testing::Test {
  Folder folder;

  void expect_refused(const std::string& file, const std::string& where, const std::string& what) {
    SCOPED_TRACE(what);
    try {
      load_graph(file);
      ADD_FAILURE() << "no error";
    } catch (const LoadError& error) {
      EXPECT_NE(error.where.find(where), std::string::npos) << error.what();
      EXPECT_NE(error.what_.find(what), std::string::npos) << error.what();
    }
  }
  void expect_refused(const MadeGraph& graph, const std::string& where, const std::string& what) {
    expect_refused(graph.write(folder), where, what);
  }
};

TEST_F(GraphFile, NodesConstantsAndOutputsAreRead) {
  const Graph graph = load_graph(small_graph().write(folder));
  ASSERT_EQ(graph.nodes.size(), 9u);
  for (size_t i = 0; i < graph.nodes.size(); i++)
    for (size_t input : graph.nodes[i].inputs) EXPECT_LT(input, i);
  EXPECT_EQ(graph.outputs, (std::map<std::string, size_t>{{"result", 8}}));
  EXPECT_EQ(graph.nodes[8].name, "out");
  EXPECT_EQ(graph.constants.at("bias").values, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(graph.constants.at("axes").values, (std::vector<float>{1, 2}));
  const auto conv = std::ranges::find(graph.nodes, "conv", &GraphNode::name);
  ASSERT_NE(conv, graph.nodes.end());
  EXPECT_EQ(conv->operation, "_FusedConv2D");
  EXPECT_EQ(conv->where, "/modelTopology/node/3 (conv)");
  EXPECT_EQ(conv->attributes.at("padding").words, std::vector<std::string>{"SAME"});
  EXPECT_EQ(conv->attributes.at("fused_ops").words, (std::vector<std::string>{"BiasAdd", "Relu"}));
  EXPECT_EQ(conv->attributes.at("strides").numbers, (std::vector<double>{1, 2, 2, 1}));
  EXPECT_EQ(graph.nodes[0].attributes.at("shape").numbers, (std::vector<double>{-1, 4, 4, 2}));
}

TEST_F(GraphFile, NodesAreSortedAndUnusedOnesLeftOut) {
  MadeGraph graph = small_graph();
  std::reverse(graph.nodes.begin(), graph.nodes.end());
  graph.node("idle", "NobodyKnows", {"conv"});
  const Graph sorted = load_graph(graph.write(folder));
  ASSERT_EQ(sorted.nodes.size(), 9u);
  for (size_t i = 0; i < sorted.nodes.size(); i++)
    for (size_t input : sorted.nodes[i].inputs) EXPECT_LT(input, i);
  // Without a signature, all that nobody reads is an output.
  graph.signature = nullptr;
  const Graph all = load_graph(graph.write(folder));
  EXPECT_TRUE(all.outputs.contains("idle") && all.outputs.contains("out"));
  EXPECT_EQ(all.outputs.size(), 2u);
}

TEST_F(GraphFile, NodesThatNobodyNeedsMayReadWhatIsNotKnown) {
  MadeGraph graph = small_graph();
  graph.node("after", "Unpack", {"conv:1"});
  EXPECT_EQ(load_graph(graph.write(folder)).nodes.size(), 9u);
  EXPECT_THROW(load_graph(graph.write(folder), {"after"}), LoadError);
}

TEST_F(GraphFile, QuantisedWeightsAreRead) {
  MadeGraph graph;
  graph.picture(1, 1, 1).tensor("half", {3}, "float32").tensor("byte", {2}, "float32");
  graph.tensor("short", {1}, "float32").node("out", "AddN", {"in", "half", "byte", "short"});
  graph.weights[0]["quantization"] = {{"dtype", "float16"}, {"original_dtype", "float32"}};
  graph.weights[1]["quantization"] = {{"dtype", "uint8"}, {"scale", 0.5}, {"min", -1}};
  graph.weights[2]["quantization"] = {{"dtype", "uint16"}, {"scale", 0.25}, {"min", 2}};
  graph.bytes = std::string("\x00\x3c\x00\xc1\x01\x00\x02\xff\x00\x80", 10);
  const Graph read = load_graph(graph.write(folder));
  EXPECT_EQ(read.constants.at("half").values, (std::vector<float>{1, -2.5f, std::exp2(-24.f)}));
  EXPECT_EQ(read.constants.at("byte").values, (std::vector<float>{0, 126.5f}));
  EXPECT_EQ(read.constants.at("short").values, std::vector<float>{8194});
  graph.bytes[1] = '\x7c';
  graph.bytes[0] = '\x01';
  expect_refused(graph, "byte 0", "not finite");
}

TEST_F(GraphFile, FaultsOfNodesAreNamed) {
  auto with = [](const std::string& pointer, const nlohmann::json& value) {
    MadeGraph graph = small_graph();
    graph.nodes[nlohmann::json::json_pointer(pointer)] = value;
    return graph;
  };
  expect_refused(with("/3/name", ""), "/modelTopology/node/3/name", "is empty");
  expect_refused(with("/3/name", "mean"), "/modelTopology/node/5 (mean)", "second node");
  expect_refused(with("/3/op", 7), "/modelTopology/node/3 (conv)/op", "text");
  expect_refused(with("/3/input/0", "nobody"), "/modelTopology/node/3 (conv)",
                 "no node called 'nobody'");
  expect_refused(with("/3/input/0", "in:1"), "/modelTopology/node/3 (conv)", "'in:1'");
  expect_refused(with("/3/input/0", "product"), "/modelTopology/node/", "circle");
  expect_refused(with("/3/input/0", "conv"), "/modelTopology/node/3 (conv)", "circle");
  expect_refused(with("/3/attr/strides/list/i/1", "two"), "(conv)/attr/strides/list/i/1", "whole");
  expect_refused(with("/3/attr/padding/s", "?"), "(conv)/attr/padding/s", "base64");
  expect_refused(with("/3/attr/padding", 1), "(conv)/attr/padding", "object");
  expect_refused(with("/0/attr/shape/shape/dim/1/size", "99999999999999"), "/dim/1/size", "whole");
  expect_refused(with("/2/name", "nameless"), "(conv)", "'bias'");
  MadeGraph circle;
  circle.picture(1, 1, 1).node("a", "Add", {"b", "in"}).node("b", "Add", {"a", "in"});
  expect_refused(circle, "/modelTopology/node", "no node is an output");
  MadeGraph weightless = small_graph();
  weightless.weights[1]["name"] = "other";
  expect_refused(weightless, "/modelTopology/node/2 (bias)", "no weights");
  MadeGraph unsigned_graph = small_graph();
  unsigned_graph.signature["outputs"]["result:0"]["name"] = "nowhere:0";
  expect_refused(unsigned_graph, "/signature/outputs/result:0", "'nowhere'");
  unsigned_graph.nodes = nlohmann::json::array();
  expect_refused(unsigned_graph, "/modelTopology/node", "list of nodes");
}

TEST_F(GraphFile, FaultsOfWeightsAreNamed) {
  MadeGraph graph = small_graph();
  graph.weights[0]["shape"] = {1 << 30, 1 << 30, 1 << 30, 1 << 30};
  expect_refused(graph, "/weightsManifest/0/weights/0 (filter)/shape/0", "whole number");
  graph.weights[0]["shape"] = {8000, 8000, 1, 1};
  expect_refused(graph, "byte 0",
                 "ends within the tensor of /weightsManifest/0/weights/0 (filter)");
  graph = small_graph();
  graph.bytes += "more";
  expect_refused(graph, "byte", "goes on");
  graph = small_graph();
  graph.weights[0]["dtype"] = "string";
  expect_refused(graph, "(filter)/dtype", "float32");
  const std::string file = graph.write(folder);
  folder.write("net.json", R"({"modelTopology":{"node":[{"name":"a","op":"b"}]}})");
  expect_refused(file, "/weightsManifest", "missing");
  folder.write("net.json", "{}");
  expect_refused(file, "/modelTopology", "missing");
  folder.write("net.json", "[]");
  expect_refused(file, "", "object");
  expect_refused(folder.file("nowhere.json"), "", "cannot be read");
}

TEST_F(GraphFile, CutAndChangedFilesAreRefusedOrRead) {
  const MadeGraph graph = small_graph();
  const std::string file = graph.write(folder), text = graph.json_text();
  for (size_t size = 0; size < text.size(); size++) {
    folder.write("net.json", text.substr(0, size));
    EXPECT_THROW(load_graph(file), LoadError) << size;
  }
  folder.write("net.json", text);
  for (size_t size = 0; size < graph.bytes.size(); size++) {
    folder.write("net.bin", graph.bytes.substr(0, size));
    EXPECT_THROW(load_graph(file), LoadError) << size;
  }
  folder.write("net.bin", graph.bytes);
  for (uint64_t i = 0; i < 1500; i++) {
    std::string changed = text;
    for (uint64_t k = 0; k <= i % 3; k++)
      changed[mix64(i * 8 + k) % text.size()] = char(mix64(i * 8 + k + 4) % 96 + 32);
    folder.write("net.json", changed);
    try {
      load_graph(file);
    } catch (const LoadError& error) {
      EXPECT_FALSE(error.what_.empty());
    }
  }
  folder.write("net.json", std::string(100000, '['));
  EXPECT_THROW(load_graph(file), LoadError);
}

}  // namespace
}  // namespace wellspring::test
