// SPDX-License-Identifier: Apache-2.0
// Knows what each operation of a graph means in OpenCV's layers.
#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <utility>

#include "kiosk/network/graph/graph_builder.h"

namespace wellspring::kiosk {

namespace {

void set_window(GraphLayer& layer, const std::array<int, 2>& size,
                const std::array<int, 2>& stride) {
  layer.numbers["kernel_h"] = {size[0]}, layer.numbers["kernel_w"] = {size[1]};
  layer.numbers["stride_h"] = {stride[0]}, layer.numbers["stride_w"] = {stride[1]};
}

// Returns a dimension's place in OpenCV's order.
int place_of_dimension(int dimension, size_t dimensions) {
  constexpr int places[] = {0, 2, 3, 1};
  return dimensions == 4 ? places[dimension] : dimension;
}

}  // namespace

void GraphBuilder::add_node(const GraphNode& node) {
  node_ = &node;
  const std::string& name = node.operation;
  auto plain = [&](const char* type) {
    count_inputs(1, 1);
    const GraphValue& from = computed(0);
    return add({type}, from, from.shape);
  };
  const std::pair<const char*, std::function<GraphValue()>> operations[] = {
      {"Placeholder", [&] { return placeholder(); }},
      {"Const",
       [&] {
         const WeightTensor& tensor = graph_.constants.at(node.name);
         return GraphValue{-1, tensor.shape, &tensor};
       }},
      {"Identity", [&] { return count_inputs(1, 1), values[node.inputs[0]]; }},
      {"Conv2D", [&] { return convolution(false, false); }},
      {"_FusedConv2D", [&] { return convolution(false, true); }},
      {"DepthwiseConv2dNative", [&] { return convolution(true, false); }},
      {"FusedDepthwiseConv2dNative", [&] { return convolution(true, true); }},
      {"MatMul", [&] { return multiplied(false); }},
      {"_FusedMatMul", [&] { return multiplied(true); }},
      {"Add", [&] { return joined("sum"); }},
      {"AddV2", [&] { return joined("sum"); }},
      {"AddN", [&] { return joined("sum"); }},
      {"Mul", [&] { return joined("prod"); }},
      {"Sub", [&] { return joined("difference"); }},
      {"Relu", [&] { return plain("ReLU"); }},
      {"Relu6", [&] { return plain("ReLU6"); }},
      {"Sigmoid", [&] { return plain("Sigmoid"); }},
      {"Prelu", [&] { return count_inputs(2, 2), prelu(computed(0), constant(1)); }},
      {"Softmax", [&] { return softmax(); }},
      {"MaxPool", [&] { return max_pool(); }},
      {"Mean", [&] { return mean(); }},
      {"Pad", [&] { return pad(); }},
      {"Cast", [&] { return cast(); }},
      {"Reshape", [&] { return reshape(); }},
      {"ExpandDims", [&] { return with_dimension(); }},
      {"Squeeze",
       [&] {
         const GraphAttribute* which = attribute("squeeze_dims");
         return without_dimensions(which ? which->numbers : std::vector<double>{});
       }},
      {"Unpack",
       [&] {
         const GraphAttribute* axis = attribute("axis");
         return without_dimensions(axis ? axis->numbers : std::vector<double>{0});
       }},
      {"ResizeBilinear", [&] { return resized(); }},
      {"ConcatV2", [&] { return concatenated(); }},
  };
  const auto* found = std::ranges::find(operations, name, [](const auto& o) { return o.first; });
  if (found == std::end(operations)) refuse("is no operation that is known");
  values.push_back(found->second());
}

GraphValue GraphBuilder::placeholder() {
  if (!input_shape.empty()) refuse("is a second input");
  const GraphAttribute* type = attribute("dtype");
  if (type && type->words != std::vector<std::string>{"DT_FLOAT"} &&
      type->words != std::vector<std::string>{"DT_INT32"})
    refuse("is neither float nor int32");
  std::vector<int> shape;
  if (const GraphAttribute* sizes = attribute("shape"))
    for (double size : sizes->numbers) shape.push_back(int(size));
  if (shape.size() != 4) refuse("is no picture: its shape has not 4 sizes");
  if (shape[0] == -1) shape[0] = 1;
  if (shape[0] != 1) refuse("holds more than one picture");
  check_shape(shape);
  return {0, input_shape = shape, nullptr};
}

GraphValue GraphBuilder::convolution(bool depthwise, bool fused) {
  count_inputs(2, fused ? 4 : 2);
  const GraphValue* from = &computed(0, 4);
  WeightTensor tensor = constant(1);
  const int channels = from->shape[3];
  if (tensor.shape.size() != 4 || tensor.shape[2] != channels)
    refuse("a filter of " + shape_text(tensor.shape) + " does not fit " + shape_text(from->shape));
  // A depthwise filter has (rows, columns, in, times): as many results of each channel.
  if (depthwise) tensor.shape = {tensor.shape[0], tensor.shape[1], 1, channels * tensor.shape[3]};
  const std::array<int, 2> size = {tensor.shape[0], tensor.shape[1]};
  const std::array<int, 2> stride = window("strides"), dilation = window("dilations");
  const Rim around = rim(*from, size, stride, dilation);
  const std::vector<int> shape = {from->shape[0], around.times[0], around.times[1],
                                  tensor.shape[3]};
  count_work(shape, double(tensor.shape[0]) * tensor.shape[1] * tensor.shape[2]);

  GraphLayer layer{"Convolution"};
  set_window(layer, size, stride);
  layer.numbers["dilation_h"] = {dilation[0]}, layer.numbers["dilation_w"] = {dilation[1]};
  layer.numbers["num_output"] = {shape[3]};
  layer.numbers["group"] = {depthwise ? channels : 1};
  layer.blobs = {filters(tensor)};
  GraphValue padded;
  if (around.before[0] == around.after[0] && around.before[1] == around.after[1]) {
    layer.numbers["pad_h"] = {around.before[0]}, layer.numbers["pad_w"] = {around.before[1]};
  } else {  // OpenCV's convolution has rims of two like sides only
    std::vector<int> larger = from->shape;
    for (size_t k = 0; k < 2; k++) larger[1 + k] += around.before[k] + around.after[k];
    padded = add(
        {"Padding",
         {{"paddings",
           {0, 0, 0, 0, around.before[0], around.after[0], around.before[1], around.after[1]}}}},
        *from, larger);
    from = &padded;
  }
  const std::vector<std::string> ends = add_bias(layer, fused, shape[3]);
  return fused_end(add(std::move(layer), *from, shape), ends);
}

// Gives a layer the bias of a fused operation; returns what comes after it.
std::vector<std::string> GraphBuilder::add_bias(GraphLayer& layer, bool fused, int channels) const {
  std::vector<std::string> ends;
  const GraphAttribute* found = fused ? attribute("fused_ops") : nullptr;
  if (found) ends = found->words;
  const bool bias = !ends.empty() && ends[0] == "BiasAdd";
  layer.numbers["bias_term"] = {bias};
  if (!bias) return ends;
  count_inputs(3, 4);
  layer.blobs.push_back(channel_numbers(constant(2), channels));
  ends.erase(ends.begin());
  return ends;
}

// Adds the end of a fused operation, after its bias.
GraphValue GraphBuilder::fused_end(GraphValue from, const std::vector<std::string>& ends) {
  if (ends.empty()) return from;
  if (ends.size() == 1 && ends[0] == "Relu") return add({"ReLU"}, from, from.shape);
  if (ends.size() == 1 && ends[0] == "Relu6") return add({"ReLU6"}, from, from.shape);
  if (ends.size() == 1 && ends[0] == "Prelu") return count_inputs(4, 4), prelu(from, constant(3));
  std::string all;
  for (const std::string& end : ends) all += (all.empty() ? "" : ", ") + end;
  refuse("ends in " + all + ", which is not known");
}

GraphValue GraphBuilder::prelu(const GraphValue& from, const WeightTensor& slopes) {
  if (from.shape.size() != 4) refuse("is known for 4 dimensions only");
  return add({.type = "PReLU", .blobs = {channel_numbers(slopes, from.shape[3])}}, from,
             from.shape);
}

GraphValue GraphBuilder::multiplied(bool fused) {
  count_inputs(2, fused ? 4 : 2);
  const GraphValue& from = computed(0, 2);
  WeightTensor matrix = constant(1);
  const bool transposed = flag("transpose_b");
  if (flag("transpose_a")) refuse("transpose_a is not known");
  if (matrix.shape.size() != 2 || matrix.shape[transposed] != from.shape[1])
    refuse("a matrix of " + shape_text(matrix.shape) + " does not fit " + shape_text(from.shape));
  const int in = from.shape[1], out = matrix.shape[!transposed];
  const std::vector<int> shape = {from.shape[0], out};
  count_work(shape, in);
  if (!transposed) {
    matrix.shape = {1, 1, in, out};
    matrix = filters(matrix);
    matrix.shape = {out, in};
  }
  GraphLayer layer{"InnerProduct", {{"num_output", {out}}}, {}, {std::move(matrix)}};
  const std::vector<std::string> ends = add_bias(layer, fused, out);
  return fused_end(add(std::move(layer), from, shape), ends);
}

// Adds or multiplies values of one shape, or one value and a constant for each channel. A
// difference is known of a value and a constant behind it.
GraphValue GraphBuilder::joined(const char* operation) {
  const bool two = node_->operation != "AddN";
  const std::string word = operation;
  const bool less = word == "difference";
  count_inputs(2, two ? 2 : 64);
  const bool first_constant = values[node_->inputs[0]].constant != nullptr;
  if (two && (first_constant || values[node_->inputs[1]].constant)) {
    const GraphValue& from = computed(first_constant ? 1 : 0);
    if (from.shape.size() == 3) refuse("with a constant is known for 2 or 4 dimensions only");
    const int channels = from.shape.back();
    const bool sum = word == "sum" || less;
    if (less && first_constant) refuse("is known without a constant in front only");
    WeightTensor numbers = channel_numbers(constant(first_constant ? 0 : 1), channels);
    if (less)
      for (float& number : numbers.values) number = -number;
    GraphLayer layer{"Scale", {{"bias_term", {sum}}}};
    if (sum) layer.blobs = {{{1, channels}, std::vector<float>(size_t(channels), 1.f)}};
    layer.blobs.push_back(std::move(numbers));
    return add(std::move(layer), from, from.shape);
  }
  if (less) refuse("is known with a constant only");
  GraphLayer layer{"Eltwise", {}, {{"operation", operation}}};
  const std::vector<int>& shape = computed(0).shape;
  for (size_t i = 0; i < node_->inputs.size(); i++) {
    layer.inputs.push_back(computed(i).layer);
    if (computed(i).shape != shape)
      refuse("shapes differ: " + shape_text(shape) + ", " + shape_text(computed(i).shape));
  }
  check_shape(shape);
  return {add(std::move(layer)), shape, nullptr};
}

GraphValue GraphBuilder::max_pool() {
  count_inputs(1, 1);
  const GraphValue& from = computed(0, 4);
  const std::array<int, 2> size = window("ksize"), stride = window("strides");
  const Rim around = rim(from, size, stride, {1, 1});
  const std::vector<int> shape = {from.shape[0], around.times[0], around.times[1], from.shape[3]};
  count_work(shape, double(size[0]) * size[1]);
  GraphLayer layer{"Pooling",
                   {{"pad_t", {around.before[0]}},
                    {"pad_b", {around.after[0]}},
                    {"pad_l", {around.before[1]}},
                    {"pad_r", {around.after[1]}},
                    {"ceil_mode", {0}}},
                   {{"pool", "max"}}};
  set_window(layer, size, stride);
  return add(std::move(layer), from, shape);
}

GraphValue GraphBuilder::mean() {
  count_inputs(2, 2);
  const GraphValue& from = computed(0, 4);
  std::vector<int> axes = whole_numbers(1);
  for (int& axis : axes) axis += axis < 0 ? 4 : 0;
  std::ranges::sort(axes);
  if (axes != std::vector{1, 2}) refuse("is known over rows and columns only");
  GraphValue out = add({"Pooling", {{"global_pooling", {1}}}, {{"pool", "ave"}}}, from,
                       {from.shape[0], 1, 1, from.shape[3]});
  if (flag("keep_dims")) return out;
  out.shape = {from.shape[0], from.shape[3]};
  out.layer = reshaped(out.layer, out.shape);
  return out;
}

GraphValue GraphBuilder::pad() {
  count_inputs(2, 2);
  const GraphValue& from = computed(0);
  const size_t dimensions = from.shape.size();
  const std::vector<int> sides = whole_numbers(1);
  if (constant(1).shape != std::vector{int(dimensions), 2})
    refuse("the list of rims does not fit " + shape_text(from.shape));
  std::vector<int> shape = from.shape, ordered(2 * dimensions);
  for (size_t k = 0; k < dimensions; k++) {
    if (sides[2 * k] < 0 || sides[2 * k + 1] < 0) refuse("a rim is below 0");
    shape[k] += sides[2 * k] + sides[2 * k + 1];
    const auto to = size_t(place_of_dimension(int(k), dimensions));
    ordered[2 * to] = sides[2 * k], ordered[2 * to + 1] = sides[2 * k + 1];
  }
  return add({"Padding", {{"paddings", ordered}}}, from, shape);
}

GraphValue GraphBuilder::reshape() {
  count_inputs(2, 2);
  const GraphValue& from = computed(0);
  std::vector<int> shape = whole_numbers(1);
  if (shape.size() < 2 || shape.size() > 4) refuse("is known to 2, 3 or 4 dimensions only");
  auto product = [](const std::vector<int>& sizes) {
    return std::accumulate(sizes.begin(), sizes.end(), 1.0, std::multiplies<>());
  };
  const double numbers = product(from.shape);
  if (const auto open = std::ranges::find(shape, -1); open != shape.end()) {
    *open = 1;
    *open = int(numbers / std::max(1.0, product(shape)));
  }
  check_shape(shape);
  if (product(shape) != numbers)
    refuse(shape_text(from.shape) + " cannot become " + shape_text(shape));
  return reshaped_value(from, shape);
}

// Gives a value another shape of as many numbers, which keep TensorFlow's order.
GraphValue GraphBuilder::reshaped_value(const GraphValue& from, const std::vector<int>& shape) {
  int last = reshaped(natural(from), shape);
  if (shape.size() == 4) last = reordered(last, {0, 3, 1, 2});
  return {last, shape, nullptr};
}

GraphValue GraphBuilder::with_dimension() {
  count_inputs(2, 2);
  const GraphValue& from = computed(0);
  std::vector<int> shape = from.shape;
  const std::vector<int> axes = whole_numbers(1);
  const int after = int(shape.size()) + 1;
  const int axis = axes.size() != 1 ? after : axes[0] < 0 ? axes[0] + after : axes[0];
  if (axis < 0 || axis >= after || after > 4) refuse("has no axis among at most 4 dimensions");
  shape.insert(shape.begin() + axis, 1);
  return reshaped_value(from, shape);
}

// Leaves out dimensions, which must have the size 1.
GraphValue GraphBuilder::without_dimensions(const std::vector<double>& which) {
  count_inputs(1, 1);
  const GraphValue& from = computed(0);
  std::vector<int> shape = from.shape;
  for (double one : which) {
    const double axis = one < 0 ? one + double(shape.size()) : one;
    if (!(axis >= 0 && axis < double(shape.size())) || shape[size_t(axis)] != 1)
      refuse("is known for a dimension of size 1 only");
    shape[size_t(axis)] = 0;
  }
  std::erase(shape, 0);
  if (shape.size() < 2 || which.empty()) refuse("leaves fewer than 2 dimensions, or names none");
  return reshaped_value(from, shape);
}

// Whole numbers of a picture are kept as floats, so that nothing is to be done.
GraphValue GraphBuilder::cast() {
  count_inputs(1, 1);
  const GraphAttribute* to = attribute("DstT");
  if (to && to->words != std::vector<std::string>{"DT_FLOAT"}) refuse("is known to floats only");
  return computed(0);
}

GraphValue GraphBuilder::resized() {
  count_inputs(2, 2);
  const GraphValue& from = computed(0, 4);
  const std::vector<int> size = whole_numbers(1);
  if (size.size() != 2) refuse("has not two sizes");
  if (!flag("half_pixel_centers") || flag("align_corners"))
    refuse("is known with half_pixel_centers and without align_corners only");
  return add({"Resize",
              {{"height", {size[0]}}, {"width", {size[1]}}, {"half_pixel_centers", {1}}},
              {{"interpolation", "bilinear"}}},
             from, {from.shape[0], size[0], size[1], from.shape[3]});
}

GraphValue GraphBuilder::concatenated() {
  const size_t count = count_inputs(3, 64) - 1;
  std::vector<int> shape = computed(0).shape;
  const std::vector<int> axes = whole_numbers(count);
  if (axes.size() != 1) refuse("has not one axis");
  const int axis = axes[0] < 0 ? axes[0] + int(shape.size()) : axes[0];
  if (axis < 0 || axis >= int(shape.size())) refuse("the axis is no dimension");
  GraphLayer layer{"Concat", {{"axis", {place_of_dimension(axis, shape.size())}}}};
  for (size_t i = 0; i < count; i++) {
    std::vector<int> other = computed(i, shape.size()).shape;
    layer.inputs.push_back(computed(i).layer);
    if (i > 0) shape[size_t(axis)] += std::exchange(other[size_t(axis)], 0);
    for (size_t k = 0; k < shape.size(); k++)
      if (i > 0 && int(k) != axis && other[k] != shape[k])
        refuse("shapes differ: " + shape_text(computed(0).shape) + ", " +
               shape_text(computed(i).shape));
  }
  check_shape(shape);
  return {add(std::move(layer)), shape, nullptr};
}

GraphValue GraphBuilder::softmax() {
  count_inputs(1, 1);
  const GraphValue& from = computed(0);
  const size_t dimensions = from.shape.size();
  return add({"Softmax", {{"axis", {place_of_dimension(int(dimensions) - 1, dimensions)}}}}, from,
             from.shape);
}

}  // namespace wellspring::kiosk
