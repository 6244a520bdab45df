// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/graph/graph_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/load_error.h"

namespace wellspring::kiosk {

namespace {

constexpr double most_multiplications = 4e9, most_numbers = 64 << 20;
constexpr int most_side = 1 << 16, most_window = 64;

}  // namespace

void GraphBuilder::refuse(const std::string& what) const {
  throw LoadError(graph_.file, node_->where, node_->operation + ": " + what);
}

int GraphBuilder::add(GraphLayer layer) {
  layers.push_back(std::move(layer));
  return int(layers.size());
}

GraphValue GraphBuilder::add(GraphLayer layer, const GraphValue& from, std::vector<int> shape) {
  check_shape(shape);
  layer.inputs = {from.layer};
  return {add(std::move(layer)), std::move(shape), nullptr};
}

int GraphBuilder::reordered(int from, const std::vector<int>& order) {
  return add({.type = "Permute", .numbers = {{"order", order}}, .inputs = {from}});
}

int GraphBuilder::reshaped(int from, const std::vector<int>& shape) {
  return add({.type = "Reshape", .numbers = {{"dim", shape}}, .inputs = {from}});
}

// Returns a layer that has the value in TensorFlow's order.
int GraphBuilder::natural(const GraphValue& value) {
  if (value.shape.size() != 4) return value.layer;
  // Both orders are the same for one pixel or one channel.
  const bool same = value.shape[1] * value.shape[2] == 1 || value.shape[3] == 1;
  return same ? reshaped(value.layer, value.shape) : reordered(value.layer, {0, 2, 3, 1});
}

void GraphBuilder::check_shape(const std::vector<int>& shape) {
  double numbers = 1;
  for (int size : shape) {
    if (size < 1 || size > most_side)
      refuse("a size of " + shape_text(shape) + " is not from 1 to " + std::to_string(most_side));
    numbers *= size;
  }
  if ((numbers_ += numbers) > most_numbers) refuse("the graph has more than 256 MiB of values");
}

// Counts multiplications: `each` for every number of a result.
void GraphBuilder::count_work(const std::vector<int>& shape, double each) {
  for (int size : shape) each *= size;
  if ((multiplications_ += each) > most_multiplications)
    refuse("the graph needs more than 4e9 multiplications");
}

size_t GraphBuilder::count_inputs(size_t least, size_t most) const {
  const size_t count = node_->inputs.size();
  if (count < least || count > most)
    refuse("has " + std::to_string(count) + " inputs instead of " + std::to_string(least));
  return count;
}

// Returns an input that is no constant, of so many dimensions; 0: of any number.
const GraphValue& GraphBuilder::computed(size_t input, size_t dimensions) const {
  const GraphValue& value = values[node_->inputs[input]];
  const std::string which = "input " + std::to_string(input);
  if (value.constant) refuse(which + " is a constant");
  if (dimensions && value.shape.size() != dimensions)
    refuse(which + " is " + shape_text(value.shape) + " and has not " + std::to_string(dimensions) +
           " dimensions");
  return value;
}

const WeightTensor& GraphBuilder::constant(size_t input) const {
  const GraphValue& value = values[node_->inputs[input]];
  if (!value.constant) refuse("input " + std::to_string(input) + " is no constant");
  return *value.constant;
}

std::vector<int> GraphBuilder::whole_numbers(size_t input) const {
  std::vector<int> out;
  for (float number : constant(input).values) {
    if (number != std::floor(number) || std::abs(number) > 1e6f)
      refuse("input " + std::to_string(input) +
             " has a number that is not whole or above a million");
    out.push_back(int(number));
  }
  if (out.size() > 16) refuse("input " + std::to_string(input) + " has more than 16 numbers");
  return out;
}

// Returns a number for each channel, of a constant that has as many, or one for all.
WeightTensor GraphBuilder::channel_numbers(const WeightTensor& tensor, int channels) const {
  WeightTensor out{{1, channels}, tensor.values};
  if (tensor.values.size() == 1) out.values.resize(size_t(channels), tensor.values[0]);
  else if (tensor.values.size() != size_t(channels) || tensor.shape.back() != channels)
    refuse("a constant of " + shape_text(tensor.shape) + " does not fit " +
           std::to_string(channels) + " channels");
  return out;
}

const GraphAttribute* GraphBuilder::attribute(const std::string& name) const {
  const auto found = node_->attributes.find(name);
  return found == node_->attributes.end() ? nullptr : &found->second;
}

bool GraphBuilder::flag(const std::string& name) const {
  const GraphAttribute* found = attribute(name);
  return found && !found->numbers.empty() && found->numbers[0] != 0;
}

// Returns rows and columns of an attribute that has a number for each of four dimensions.
std::array<int, 2> GraphBuilder::window(const std::string& name) const {
  const GraphAttribute* found = attribute(name);
  if (!found) return {1, 1};
  const std::vector<double>& n = found->numbers;
  auto fits = [](double size) { return size >= 1 && size <= most_window; };
  if (n.size() != 4 || n[0] != 1 || n[3] != 1 || !fits(n[1]) || !fits(n[2]))
    refuse(name + " is not 1, two numbers from 1 to " + std::to_string(most_window) + ", 1");
  return {int(n[1]), int(n[2])};
}

// SAME puts the larger half of the rim after the picture, VALID has none.
GraphBuilder::Rim GraphBuilder::rim(const GraphValue& from, const std::array<int, 2>& size,
                                    const std::array<int, 2>& stride,
                                    const std::array<int, 2>& dilation) const {
  const GraphAttribute* padding = attribute("padding");
  const std::string kind = padding && !padding->words.empty() ? padding->words[0] : "";
  if (kind != "SAME" && kind != "VALID") refuse("padding is not SAME or VALID");
  if (const GraphAttribute* format = attribute("data_format");
      format && format->words != std::vector<std::string>{"NHWC"})
    refuse("data_format is not NHWC");
  Rim out;
  for (size_t k = 0; k < 2; k++) {
    const int side = from.shape[1 + k], reach = (size[k] - 1) * dilation[k] + 1;
    if (kind == "VALID") {
      if (reach > side)
        refuse("a window of " + std::to_string(reach) + " is larger than a side of " +
               std::to_string(side));
      out.times[k] = (side - reach) / stride[k] + 1;
    } else {
      out.times[k] = (side + stride[k] - 1) / stride[k];
      const int all = std::max(0, (out.times[k] - 1) * stride[k] + reach - side);
      out.before[k] = all / 2, out.after[k] = all - all / 2;
    }
  }
  return out;
}

int GraphBuilder::add_output(size_t node) {
  node_ = &graph_.nodes[node];
  const GraphValue& value = values[node];
  if (value.constant) refuse("an output is a constant");
  check_shape(value.shape);
  // A layer of its own stays when OpenCV joins layers.
  return add({.type = "Identity", .inputs = {natural(value)}});
}

}  // namespace wellspring::kiosk
