// SPDX-License-Identifier: Apache-2.0
// Each operation against values computed by hand, and graphs that no network can be made of.
#include "kiosk/network/graph/graph_network.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "base/load_error.h"
#include "base/rng.h"
#include "unit/kiosk/network/graph/made_graph.h"

namespace wellspring::test {
namespace {

using Numbers = std::vector<float>;
using json = nlohmann::json;

json window(const std::vector<int>& stride, const std::string& padding) {
  return {{"strides", MadeGraph::whole(stride)}, {"padding", MadeGraph::word(padding)}};
}
json pooling(int size, int stride, const std::string& padding) {
  json attributes = window({1, stride, stride, 1}, padding);
  attributes["ksize"] = MadeGraph::whole({1, size, size, 1});
  return attributes;
}
json with(json attributes, const std::string& name, json value) {
  attributes[name] = std::move(value);
  return attributes;
}

struct GraphRun : testing::Test {
  Folder folder;
  std::vector<int> shape;  // the last result's

  // The graph's node "out".
  Numbers run(const MadeGraph& graph, const Numbers& planes) {
    GraphNetwork network = open_graph(graph.write(folder));
    const Tensors outputs = network.run(planes);
    EXPECT_EQ(outputs.size(), 1u);
    shape = outputs.at("out").shape;
    return outputs.at("out").values;
  }
  void expect_refused(const MadeGraph& graph, const std::string& node, const std::string& what) {
    SCOPED_TRACE(what);
    try {
      open_graph(graph.write(folder));
      ADD_FAILURE() << "no error";
    } catch (const LoadError& error) {
      EXPECT_NE(error.where.find("(" + node + ")"), std::string::npos) << error.what();
      EXPECT_NE(error.what_.find(what), std::string::npos) << error.what();
    }
  }
};

const Numbers nine = {1, 2, 3, 4, 5, 6, 7, 8, 9};

TEST_F(GraphRun, Convolution) {
  auto square = [](const json& attributes) {
    MadeGraph graph;
    graph.picture(3, 3, 1).constant("filter", {2, 2, 1, 1}, {1, 2, 3, 4});
    return graph.node("out", "Conv2D", {"in", "filter"}, attributes);
  };
  const json valid = window({1, 1, 1, 1}, "VALID");
  EXPECT_EQ(run(square(valid), nine), (Numbers{37, 47, 67, 77}));
  EXPECT_EQ(shape, (std::vector<int>{1, 2, 2, 1}));
  // The larger half of the rim is after the picture.
  EXPECT_EQ(run(square(window({1, 1, 1, 1}, "SAME")), nine),
            (Numbers{37, 47, 21, 67, 77, 33, 23, 26, 9}));
  EXPECT_EQ(run(square(window({1, 2, 2, 1}, "SAME")), nine), (Numbers{37, 21, 23, 9}));
  const json wide = with(valid, "dilations", MadeGraph::whole({1, 2, 2, 1}));
  EXPECT_EQ(run(square(wide), nine), Numbers{1 + 6 + 21 + 36});
  // Strides that differ.
  EXPECT_EQ(run(square(window({1, 1, 2, 1}, "VALID")), nine), (Numbers{37, 67}));
}

TEST_F(GraphRun, ConvolutionOfColours) {
  MadeGraph graph;
  graph.picture(1, 2, 2).constant("filter", {1, 1, 2, 3}, {1, 2, 3, 4, 5, 6});
  graph.node("out", "Conv2D", {"in", "filter"}, window({1, 1, 1, 1}, "SAME"));
  // Planes go in, pixels come out.
  EXPECT_EQ(run(graph, {1, 2, 10, 20}), (Numbers{41, 52, 63, 82, 104, 126}));
  EXPECT_EQ(shape, (std::vector<int>{1, 1, 2, 3}));
}

TEST_F(GraphRun, DepthwiseConvolution) {
  MadeGraph graph;
  graph.picture(1, 2, 2).constant("filter", {1, 2, 2, 2}, {1, 2, 3, 4, 5, 6, 7, 8});
  graph.node("out", "DepthwiseConv2dNative", {"in", "filter"}, window({1, 1, 1, 1}, "VALID"));
  // Channel 0 has 1, 2: 1*1+2*5 and 1*2+2*6; channel 1 has 10, 20.
  EXPECT_EQ(run(graph, {1, 2, 10, 20}), (Numbers{11, 14, 170, 200}));
}

TEST_F(GraphRun, FusedConvolution) {
  auto graph = [](const std::string& operation, const std::vector<std::string>& ends) {
    MadeGraph made;
    std::vector<std::string> inputs = {"in", "filter", "bias"};
    made.picture(1, 4, 1).constant("filter", {1, 1, 1, 1}, {2}).constant("bias", {1}, {1});
    made.constant("slope", {1, 1, 1}, {0.5f});
    if (ends.back() == "Prelu") inputs.push_back("slope");
    return made.node("out", operation, inputs,
                     with(window({1, 1, 1, 1}, "VALID"), "fused_ops", MadeGraph::words(ends)));
  };
  const Numbers planes = {-4, -1, 1, 4};
  for (const char* operation : {"_FusedConv2D", "FusedDepthwiseConv2dNative"}) {
    EXPECT_EQ(run(graph(operation, {"BiasAdd"}), planes), (Numbers{-7, -1, 3, 9}));
    EXPECT_EQ(run(graph(operation, {"BiasAdd", "Relu"}), planes), (Numbers{0, 0, 3, 9}));
    EXPECT_EQ(run(graph(operation, {"BiasAdd", "Relu6"}), planes), (Numbers{0, 0, 3, 6}));
    EXPECT_EQ(run(graph(operation, {"BiasAdd", "Prelu"}), planes), (Numbers{-3.5f, -0.5f, 3, 9}));
  }
  expect_refused(graph("_FusedConv2D", {"BiasAdd", "Tanh"}), "out", "Tanh, which is not known");
}

TEST_F(GraphRun, Matrix) {
  auto graph = [](const std::string& operation, const json& attributes) {
    MadeGraph made;
    made.picture(1, 3, 1)
        .whole_constant("row", {2}, {1, -1})
        .node("flat", "Reshape", {"in", "row"});
    const bool transposed = attributes.contains("transpose_b");
    made.constant("matrix", transposed ? std::vector{2, 3} : std::vector{3, 2}, {1, 2, 3, 4, 5, 6});
    made.constant("bias", {2}, {-30, 10});
    std::vector<std::string> inputs = {"flat", "matrix"};
    if (operation == "_FusedMatMul") inputs.push_back("bias");
    return made.node("out", operation, inputs, attributes);
  };
  EXPECT_EQ(run(graph("MatMul", json::object()), {1, 2, 3}), (Numbers{22, 28}));
  EXPECT_EQ(shape, (std::vector<int>{1, 2}));
  EXPECT_EQ(run(graph("MatMul", {{"transpose_b", {{"b", true}}}}), {1, 2, 3}), (Numbers{14, 32}));
  EXPECT_EQ(
      run(graph("_FusedMatMul", {{"fused_ops", MadeGraph::words({"BiasAdd", "Relu"})}}), {1, 2, 3}),
      (Numbers{0, 38}));
}

TEST_F(GraphRun, SumsAndProducts) {
  auto graph = [](const std::string& operation, const std::string& other, bool turned = false) {
    MadeGraph made;
    made.picture(1, 2, 2).constant("channels", {2}, {3, -1}).constant("one", {}, {2});
    made.constant("wide", {1, 1, 1, 2}, {5, 6});
    if (other == "twice") made.node("twice", "Add", {"in", "in"});
    return made.node(
        "out", operation,
        turned ? std::vector{other, std::string("in")} : std::vector{std::string("in"), other});
  };
  const Numbers planes = {1, 2, 10, 20};  // pixels: 1, 10 and 2, 20
  EXPECT_EQ(run(graph("AddV2", "channels"), planes), (Numbers{4, 9, 5, 19}));
  EXPECT_EQ(run(graph("Add", "channels", true), planes), (Numbers{4, 9, 5, 19}));
  EXPECT_EQ(run(graph("Mul", "channels"), planes), (Numbers{3, -10, 6, -20}));
  EXPECT_EQ(run(graph("Mul", "one"), planes), (Numbers{2, 20, 4, 40}));
  EXPECT_EQ(run(graph("AddV2", "wide"), planes), (Numbers{6, 16, 7, 26}));
  EXPECT_EQ(run(graph("AddV2", "twice"), planes), (Numbers{3, 30, 6, 60}));
  EXPECT_EQ(run(graph("Mul", "twice"), planes), (Numbers{2, 200, 8, 800}));
  EXPECT_EQ(run(graph("AddN", "in"), planes), (Numbers{2, 20, 4, 40}));
}

TEST_F(GraphRun, ChannelsOfTwoDimensions) {
  MadeGraph graph;
  graph.picture(1, 1, 3).whole_constant("row", {2}, {1, 3}).node("flat", "Reshape", {"in", "row"});
  graph.constant("factor", {3}, {2, 3, 4}).constant("more", {3}, {1, 1, -1});
  graph.node("scaled", "Mul", {"flat", "factor"}).node("out", "AddV2", {"scaled", "more"});
  EXPECT_EQ(run(graph, {1, 2, 3}), (Numbers{3, 7, 11}));
}

TEST_F(GraphRun, Activations) {
  auto graph = [](const std::string& operation) {
    return MadeGraph().picture(1, 2, 2).node("out", operation, {"in"});
  };
  const Numbers planes = {-1, 8, 3, 0};  // pixels: -1, 3 and 8, 0
  EXPECT_EQ(run(graph("Relu"), planes), (Numbers{0, 3, 8, 0}));
  EXPECT_EQ(run(graph("Relu6"), planes), (Numbers{0, 3, 6, 0}));
  EXPECT_EQ(run(graph("Identity"), planes), (Numbers{-1, 3, 8, 0}));
  const Numbers sigmoid = run(graph("Sigmoid"), planes);
  EXPECT_NEAR(sigmoid[0], 0.268941f, 1e-5f);
  EXPECT_NEAR(sigmoid[3], 0.5f, 1e-5f);
  const Numbers softmax = run(graph("Softmax"), planes);
  EXPECT_NEAR(softmax[0], 0.017986f, 1e-5f);  // the share of -1 beside 3
  EXPECT_NEAR(softmax[1], 0.982014f, 1e-5f);
  EXPECT_NEAR(softmax[2] + softmax[3], 1, 1e-5f);
  MadeGraph slopes;
  slopes.picture(1, 2, 2).constant("slope", {1, 1, 2}, {0.5f, -2});
  slopes.node("out", "Prelu", {"in", "slope"});
  EXPECT_EQ(run(slopes, {-1, 8, -3, 1}), (Numbers{-0.5f, 6, 8, 1}));
}

TEST_F(GraphRun, SoftmaxOfARow) {
  MadeGraph graph;
  graph.picture(1, 2, 1).whole_constant("row", {2}, {1, 2}).node("flat", "Reshape", {"in", "row"});
  const Numbers found = run(graph.node("out", "Softmax", {"flat"}), {0, std::log(3.f)});
  EXPECT_NEAR(found[0], 0.25f, 1e-6f);
  EXPECT_NEAR(found[1], 0.75f, 1e-6f);
}

TEST_F(GraphRun, MaxPool) {
  auto graph = [](const json& attributes) {
    return MadeGraph().picture(3, 3, 1).node("out", "MaxPool", {"in"}, attributes);
  };
  const Numbers below = {-1, -2, -3, -4, -5, -6, -7, -8, -9};
  EXPECT_EQ(run(graph(pooling(2, 1, "VALID")), nine), (Numbers{5, 6, 8, 9}));
  EXPECT_EQ(run(graph(pooling(2, 2, "VALID")), nine), Numbers{5});
  // The rim counts nowhere, also where all else is below 0.
  EXPECT_EQ(run(graph(pooling(2, 2, "SAME")), below), (Numbers{-1, -3, -7, -9}));
  EXPECT_EQ(run(graph(pooling(3, 2, "SAME")), below), (Numbers{-1, -2, -4, -5}));
}

TEST_F(GraphRun, Mean) {
  auto graph = [](std::vector<int> axes, bool keep) {
    MadeGraph made;
    made.picture(1, 2, 2).whole_constant("axes", {int(axes.size())}, axes);
    return made.node("out", "Mean", {"in", "axes"}, {{"keep_dims", {{"b", keep}}}});
  };
  EXPECT_EQ(run(graph({1, 2}, false), {1, 2, 10, 20}), (Numbers{1.5f, 15}));
  EXPECT_EQ(shape, (std::vector<int>{1, 2}));
  EXPECT_EQ(run(graph({-2, -3}, true), {1, 2, 10, 20}), (Numbers{1.5f, 15}));
  EXPECT_EQ(shape, (std::vector<int>{1, 1, 1, 2}));
  expect_refused(graph({1}, false), "out", "rows and columns only");
}

TEST_F(GraphRun, Pad) {
  MadeGraph graph;
  graph.picture(1, 2, 1).whole_constant("rims", {4, 2}, {0, 0, 0, 1, 1, 0, 0, 1});
  graph.node("out", "Pad", {"in", "rims"});
  EXPECT_EQ(run(graph, {5, 6}), (Numbers{0, 0, 5, 0, 6, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(shape, (std::vector<int>{1, 2, 3, 2}));
}

TEST_F(GraphRun, Reshape) {
  MadeGraph graph;
  graph.picture(2, 2, 2).whole_constant("first", {3}, {1, -1, 4});
  graph.node("rows", "Reshape", {"in", "first"}).whole_constant("second", {4}, {1, 4, 1, 2});
  graph.node("out", "Reshape", {"rows", "second"});
  // Pixels 1, 10; 2, 20; 3, 30; 4, 40 keep their order.
  EXPECT_EQ(run(graph, {1, 2, 3, 4, 10, 20, 30, 40}), (Numbers{1, 10, 2, 20, 3, 30, 4, 40}));
  EXPECT_EQ(shape, (std::vector<int>{1, 4, 1, 2}));
  graph.whole_constant("third", {2}, {3, -1}).node("wrong", "Reshape", {"in", "third"});
  expect_refused(graph, "wrong", "1x2x2x2 cannot become 3x2");
}

TEST_F(GraphRun, Concatenation) {
  auto graph = [](int axis) {
    MadeGraph made;
    made.picture(1, 2, 2).whole_constant("axis", {}, {axis}).node("more", "Add", {"in", "in"});
    return made.node("out", "ConcatV2", {"in", "more", "axis"});
  };
  const Numbers planes = {1, 2, 10, 20};
  EXPECT_EQ(run(graph(3), planes), (Numbers{1, 10, 2, 20, 2, 20, 4, 40}));
  EXPECT_EQ(shape, (std::vector<int>{1, 1, 2, 4}));
  EXPECT_EQ(run(graph(-2), planes), (Numbers{1, 10, 2, 20, 2, 20, 4, 40}));
  EXPECT_EQ(shape, (std::vector<int>{1, 1, 4, 2}));
  expect_refused(graph(4), "out", "no dimension");
}

TEST_F(GraphRun, Differences) {
  auto graph = [](const std::vector<std::string>& inputs) {
    MadeGraph made;
    made.picture(1, 2, 2).constant("channels", {1, 1, 1, 2}, {3, -1}).constant("one", {}, {2});
    return made.node("out", "Sub", inputs);
  };
  EXPECT_EQ(run(graph({"in", "channels"}), {1, 2, 10, 20}), (Numbers{-2, 11, -1, 21}));
  EXPECT_EQ(run(graph({"in", "one"}), {1, 2, 10, 20}), (Numbers{-1, 8, 0, 18}));
  expect_refused(graph({"one", "in"}), "out", "without a constant in front");
  expect_refused(graph({"in", "in"}), "out", "with a constant only");
}

TEST_F(GraphRun, WholeNumbersAndDimensionsOfOne) {
  auto graph = [](const char* type, int axis) {
    MadeGraph made;
    made.picture(1, 2, 2).whole_constant("axis", {}, {axis});
    made.nodes[0]["attr"]["dtype"]["type"] = type;
    made.node("floats", "Cast", {"in"}, {{"DstT", {{"type", "DT_FLOAT"}}}})
        .node("first", "Unpack", {"floats"}, {{"axis", {{"i", "0"}}}, {"num", {{"i", "1"}}}})
        .node("again", "ExpandDims", {"first", "axis"});
    return made.node("out", "Squeeze", {"again"}, {{"squeeze_dims", MadeGraph::whole({axis})}});
  };
  EXPECT_EQ(run(graph("DT_INT32", 0), {1, 2, 10, 20}), (Numbers{1, 10, 2, 20}));
  EXPECT_EQ(shape, (std::vector<int>{1, 2, 2}));
  EXPECT_EQ(run(graph("DT_FLOAT", -1), {1, 2, 10, 20}), (Numbers{1, 10, 2, 20}));
  expect_refused(graph("DT_STRING", 0), "in", "neither float nor int32");
  expect_refused(graph("DT_FLOAT", 7), "again", "no axis");
  MadeGraph wide;
  wide.picture(2, 2, 1).node("out", "Squeeze", {"in"}, {{"squeeze_dims", MadeGraph::whole({1})}});
  expect_refused(wide, "out", "of size 1 only");
  MadeGraph cut;
  cut.picture(2, 2, 1).node("out", "Cast", {"in"}, {{"DstT", {{"type", "DT_INT32"}}}});
  expect_refused(cut, "out", "to floats only");
}

TEST_F(GraphRun, Resizing) {
  auto graph = [](std::vector<int> size, bool half) {
    MadeGraph made;
    made.picture(1, 2, 1).whole_constant("size", {int(size.size())}, size);
    return made.node("out", "ResizeBilinear", {"in", "size"},
                     {{"half_pixel_centers", {{"b", half}}}, {"align_corners", {{"b", false}}}});
  };
  // Centres of pixels lie at halves: those of the four are at 0.25, 0.75, 1.25, 1.75 of two.
  EXPECT_EQ(run(graph({1, 4}, true), {0, 4}), (Numbers{0, 1, 3, 4}));
  EXPECT_EQ(shape, (std::vector<int>{1, 1, 4, 1}));
  expect_refused(graph({1, 4}, false), "out", "half_pixel_centers");
  expect_refused(graph({4}, true), "out", "two sizes");
  expect_refused(graph({0, 4}, true), "out", "from 1 to");
}

TEST_F(GraphRun, CutGraphsEndWhereTheyAreCut) {
  MadeGraph graph = small_graph();
  graph.node("after", "NobodyKnows", {"out"});
  graph.signature["outputs"]["result:0"]["name"] = "after";
  const std::string file = graph.write(folder);
  GraphNetwork network(load_graph(file, {"conv", "mean"}));
  const Tensors outputs = network.run(Numbers(32, 1.f));
  ASSERT_EQ(outputs.size(), 2u);
  EXPECT_EQ(outputs.at("conv").shape, (std::vector<int>{1, 2, 2, 3}));
  EXPECT_EQ(outputs.at("mean").shape, (std::vector<int>{1, 3}));
  EXPECT_THROW(load_graph(file, {"nobody"}), LoadError);
}

TEST_F(GraphRun, WholeNetwork) {
  const Numbers planes(32, 1);
  GraphNetwork network = open_graph(small_graph().write(folder));
  EXPECT_EQ(network.input().rows, 4);
  EXPECT_EQ(network.input().channels, 2);
  const Numbers first = network.run(planes).at("result").values;
  // Sums of the filter by channel, plus bias: -1 + 1, -2 + 2, 2 + 3 by hand.
  Numbers sums = {1, 2, 3};
  for (size_t i = 0; i < 24; i++) sums[i % 3] += float(i % 5) - 2;
  for (float& sum : sums) sum = std::max(sum, 0.f);
  EXPECT_EQ(first, (Numbers{sums[0] + sums[2], sums[1] + sums[2]}));
  EXPECT_EQ(network.run(planes).at("result").values, first);
  EXPECT_THROW(network.run(Numbers(31)), std::invalid_argument);
}

TEST_F(GraphRun, AllOperationsTogether) {
  const Numbers found = run(wide_graph(), Numbers(36, 1));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0] + found[1], 1, 1e-6f);
}

TEST_F(GraphRun, SeveralOutputsHaveNames) {
  MadeGraph graph;
  graph.picture(1, 1, 2).node("a", "Relu", {"in"}).node("b", "Add", {"a", "in"});
  graph.signature = {{"outputs",
                      {{"first", {{"name", "b:0"}}},
                       {"again", {{"name", "b"}}},
                       {"second:0", {{"name", "a:0"}}}}}};
  const Tensors found = open_graph(graph.write(folder)).run(Numbers{-1, 2});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found.at("first").values, (Numbers{-1, 4}));
  EXPECT_EQ(found.at("again").values, (Numbers{-1, 4}));
  EXPECT_EQ(found.at("second").values, (Numbers{0, 2}));
}

TEST_F(GraphRun, WhatIsNotKnownIsNamed) {
  auto picture = [] { return MadeGraph().picture(2, 2, 1); };
  expect_refused(picture().node("n", "GatherNd", {"in"}), "n", "GatherNd: is no operation");
  expect_refused(picture().node("n", "Relu", {"in", "in"}), "n", "2 inputs instead of 1");
  expect_refused(picture().node("n", "Conv2D", {"in"}), "n", "1 inputs");
  expect_refused(picture().node("n", "Conv2D", {"in", "in"}), "n", "input 1 is no constant");
  MadeGraph filtered = picture().constant("f", {1, 1, 2, 1}, {1, 2});
  expect_refused(MadeGraph(filtered).node("n", "Conv2D", {"in", "f"}), "n",
                 "a filter of 1x1x2x1 does not fit 1x2x2x1");
  expect_refused(MadeGraph(filtered).node("n", "Add", {"f", "f"}), "n", "is a constant");
  expect_refused(MadeGraph(filtered).node("n", "Add", {"in", "f"}), "n", "does not fit 1 channels");
  filtered = picture().constant("f", {3, 3, 1, 1}, Numbers(9));
  auto conv = [&](const json& attributes) {
    return MadeGraph(filtered).node("n", "Conv2D", {"in", "f"}, attributes);
  };
  const json one = window({1, 1, 1, 1}, "SAME");
  expect_refused(conv(window({1, 1, 1, 1}, "VALID")), "n", "a window of 3 is larger than a side");
  expect_refused(conv(window({1, 1, 1, 1}, "EXPLICIT")), "n", "SAME or VALID");
  expect_refused(conv(window({1, 0, 1, 1}, "SAME")), "n", "strides");
  expect_refused(conv(window({1, 1000000, 1, 1}, "SAME")), "n", "strides");
  expect_refused(conv(with(one, "dilations", MadeGraph::whole({1, 1}))), "n", "dilations");
  expect_refused(conv(with(one, "data_format", MadeGraph::word("NCHW"))), "n", "NHWC");
  MadeGraph two = picture();
  two.nodes.push_back(two.nodes[0]);
  two.nodes[1]["name"] = "second";
  expect_refused(two.node("n", "Add", {"in", "second"}), "second", "second input");
  MadeGraph whole = picture();
  whole.nodes[0]["attr"]["dtype"]["type"] = "DT_BOOL";
  expect_refused(whole.node("n", "Relu", {"in"}), "in", "neither float nor int32");
  MadeGraph none;
  none.constant("c", {2, 2}, {1, 2, 3, 4}).node("n", "Identity", {"c"});
  expect_refused(none, "n", "an output is a constant");
}

TEST_F(GraphRun, HugeGraphsAreRefused) {
  auto large = [](int side) { return MadeGraph().picture(side, side, 3); };
  expect_refused(large(100000).node("n", "Relu", {"in"}), "in", "is not from 1 to 65536");
  expect_refused(large(-1).node("n", "Relu", {"in"}), "in", "is not from 1");
  expect_refused(large(20000).node("n", "Relu", {"in"}), "in", "more than 256 MiB");
  MadeGraph many = large(100);
  std::string last = "in";
  for (int i = 0; i < 5000; i++) {
    many.node("n" + std::to_string(i), "Relu", {last});
    last = "n" + std::to_string(i);
  }
  expect_refused(many, "n2235", "more than 256 MiB");
  MadeGraph work = large(1000);
  work.constant("f", {60, 60, 3, 1}, Numbers(60 * 60 * 3));
  work.node("n", "Conv2D", {"in", "f"}, window({1, 1, 1, 1}, "SAME"));
  expect_refused(work, "n", "more than 4e9");
  MadeGraph rims = large(2).whole_constant("r", {4, 2}, {0, 0, 0, 1000000, 0, 0, 0, 0});
  expect_refused(rims.node("n", "Pad", {"in", "r"}), "n", "is not from 1 to 65536");
}

// Whatever a changed file says, it is refused or makes a network that runs.
TEST_F(GraphRun, ChangedGraphsAreRefusedOrRun) {
  int made = 0;
  for (uint64_t i = 0; i < 1500; i++) {
    const MadeGraph graph = i % 2 ? small_graph() : wide_graph();
    const std::string file = graph.write(folder), text = graph.json_text();
    std::string changed = text;
    for (uint64_t k = 0; k <= i % 3; k++) {
      char& at = changed[mix64(i * 8 + k) % text.size()];
      at = std::isdigit(at) ? char('0' + mix64(i * 8 + k + 4) % 10)
                            : char(mix64(i * 8 + k + 4) % 96 + 32);
    }
    folder.write("net.json", changed);
    try {
      open_graph(file), made++;
    } catch (const LoadError& error) {
      EXPECT_FALSE(error.what_.empty());
    }
  }
  EXPECT_GT(made, 0);
}

}  // namespace
}  // namespace wellspring::test
