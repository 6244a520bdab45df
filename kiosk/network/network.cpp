// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/network.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/dnn.hpp>
#include <stdexcept>
#include <utility>

#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::kiosk {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr size_t most_bytes = 64 << 20;  // size of one file
constexpr size_t most_dimensions = 4;

// Describes an array's element in messages: by its index and its name if it has one.
std::string place(size_t index, const json& entry) {
  std::string where = "/0/weights/" + std::to_string(index);
  if (entry.is_object() && entry.contains("name") && entry["name"].is_string())
    where += " (" + entry["name"].get<std::string>().substr(0, 80) + ")";
  return where;
}

struct Reader {
  std::string manifest, bytes_file, bytes;
  size_t at = 0;

  [[noreturn]] void refuse(const std::string& where, const std::string& what) const {
    throw LoadError(manifest, where, what);
  }

  // Returns whether the entry's dtype is this one; it may be missing or no text.
  static bool has_type(const json& entry, const char* type) {
    return entry.contains("dtype") && entry["dtype"] == type;
  }

  float number(const json& entry, const char* key, const std::string& where) const {
    if (!entry.contains(key) || !entry[key].is_number())
      refuse(where, std::string("quantization has no number '") + key + "'");
    const float value = entry[key].get<float>();
    if (!std::isfinite(value)) refuse(where, std::string("'") + key + "' is not finite");
    return value;
  }

  WeightTensor tensor(const json& entry, const std::string& where) {
    WeightTensor out;
    if (!entry.contains("shape") || !entry["shape"].is_array() || entry["shape"].empty() ||
        entry["shape"].size() > most_dimensions)
      refuse(where, "shape is no array of one to four sizes");
    size_t count = 1;
    for (const json& size : entry["shape"]) {
      if (!size.is_number_unsigned() || size.get<uint64_t>() == 0 ||
          size.get<uint64_t>() > most_bytes / count)
        refuse(where, "a size is no whole number above 0 that the file could hold");
      out.shape.push_back(size.get<int>());
      count *= size.get<size_t>();
    }
    if (!has_type(entry, "float32")) refuse(where, "dtype is not float32");
    const bool quantised = entry.contains("quantization");
    const size_t needed = quantised ? count : 4 * count;
    if (bytes.size() - at < needed)
      throw LoadError(bytes_file, "byte " + std::to_string(at),
                      "ends within the tensor of " + manifest + where);
    out.values.resize(count);
    if (quantised) {
      const json& rule = entry["quantization"];
      if (!rule.is_object() || !has_type(rule, "uint8"))
        refuse(where, "quantization's dtype is not uint8");
      const float scale = number(rule, "scale", where), min = number(rule, "min", where);
      for (size_t i = 0; i < count; i++)
        out.values[i] = float(uint8_t(bytes[at + i])) * scale + min;
    } else {
      std::memcpy(out.values.data(), bytes.data() + at, needed);
    }
    for (size_t i = 0; i < count; i++)
      if (!std::isfinite(out.values[i]))
        throw LoadError(bytes_file, "byte " + std::to_string(at + i * needed / count),
                        "a weight is not finite");
    at += needed;
    return out;
  }
};

std::string shape_text(const std::vector<int>& shape) {
  std::string text;
  for (int size : shape) text += (text.empty() ? "" : "x") + std::to_string(size);
  return text;
}

}  // namespace

WeightSet load_weight_set(const std::string& folder, const std::string& name) {
  Reader reader;
  reader.manifest = (fs::path(folder) / (name + "-weights_manifest.json")).string();
  const json root = json::parse(read_file(reader.manifest, most_bytes), nullptr, false);
  if (root.is_discarded()) reader.refuse("", "is no JSON");
  if (!root.is_array() || root.size() != 1 || !root[0].is_object())
    reader.refuse("", "is no array of one group of weights");
  const json& group = root[0];
  if (!group.contains("paths") || !group["paths"].is_array() || group["paths"].size() != 1 ||
      !group["paths"][0].is_string())
    reader.refuse("/0/paths", "does not name one file");
  const std::string path = group["paths"][0].get<std::string>();
  if (path.empty() || path.find_first_of("/\\") != std::string::npos)
    reader.refuse("/0/paths/0", "is no name of a file in the same folder");
  if (!group.contains("weights") || !group["weights"].is_array())
    reader.refuse("/0/weights", "is no array");
  reader.bytes_file = (fs::path(folder) / path).string();
  reader.bytes = read_file(reader.bytes_file, most_bytes);

  WeightSet set{reader.manifest, {}};
  size_t index = 0;
  for (const json& entry : group["weights"]) {
    const std::string where = place(index++, entry);
    if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string())
      reader.refuse(where, "a tensor has no name");
    const std::string tensor = entry["name"].get<std::string>();
    if (!set.tensors.emplace(tensor, reader.tensor(entry, where)).second)
      reader.refuse(where, "a second tensor of this name");
  }
  if (reader.at != reader.bytes.size())
    throw LoadError(reader.bytes_file, "byte " + std::to_string(reader.at),
                    "goes on after the last tensor");
  return set;
}

WeightTensor take_tensor(WeightSet& set, const std::string& name, const std::vector<int>& shape) {
  auto found = set.tensors.find(name);
  if (found == set.tensors.end()) throw LoadError(set.file, name, "no such tensor");
  if (found->second.shape != shape)
    throw LoadError(
        set.file, name,
        "has the shape " + shape_text(found->second.shape) + " instead of " + shape_text(shape));
  WeightTensor out = std::move(found->second);
  set.tensors.erase(found);
  return out;
}

namespace {

using cv::dnn::LayerParams;

struct Means {
  float red, green, blue;
};

cv::Mat blob(std::vector<int> sizes, const std::vector<float>& values) {
  cv::Mat out(sizes, CV_32F);
  std::copy(values.begin(), values.end(), out.ptr<float>());
  return out;
}

// Puts TensorFlow's filters (rows, columns, in, out) into OpenCV's order (out, in, rows, columns).
cv::Mat filters(const WeightTensor& t) {
  const int rows = t.shape[0], columns = t.shape[1], in = t.shape[2], out = t.shape[3];
  std::vector<float> values(t.values.size());
  for (int o = 0; o < out; o++)
    for (int i = 0; i < in; i++)
      for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++)
          values[size_t(((o * in + i) * rows + r) * columns + c)] =
              t.values[size_t(((r * columns + c) * in + i) * out + o)];
  return blob({out, in, rows, columns}, values);
}

// Builds a graph that grows at its end.
class Builder {
 public:
  explicit Builder(WeightSet weights) : weights_(std::move(weights)) {}

  int add(const std::string& type, LayerParams params, std::vector<int> inputs) {
    const int id = net_.addLayer(type + std::to_string(count_++), type, params);
    for (size_t i = 0; i < inputs.size(); i++) net_.connect(inputs[i], 0, id, int(i));
    return id;
  }
  int relu(int from, float slope = 0) {
    LayerParams params;
    params.set("negative_slope", slope);
    return add("ReLU", params, {from});
  }
  int sum(std::vector<int> from) {
    LayerParams params;
    params.set("operation", "sum");
    return add("Eltwise", params, from);
  }
  // Pools 2x2; at the right and lower rim windows reach over the picture's end, and values outside
  // do not count.
  int max_pool(int from, int stride) {
    LayerParams params;
    params.set("pool", "max");
    params.set("kernel_size", 2);
    params.set("stride", stride);
    params.set("pad_l", 0), params.set("pad_t", 0);
    params.set("pad_r", 2 - stride), params.set("pad_b", 2 - stride);
    params.set("ceil_mode", true);
    return add("Pooling", params, {from});
  }
  // Pads the end: strides of 2 leave out the first rows and columns, as TensorFlow's "same" does
  // for even sides.
  int pad_end(int from) {
    LayerParams params;
    const int ends[] = {0, 0, 0, 0, 0, 1, 0, 1};
    params.set("paddings", cv::dnn::DictValue::arrayInt(ends, 8));
    return add("Padding", params, {from});
  }
  // Convolves without a rim around the picture: two rows and columns get lost for a side of 3.
  int convolution(int from, const std::string& name, int side, int in, int out, int stride) {
    LayerParams params = convolution_params(side, stride, 0, out);
    params.blobs = {filters(take_tensor(weights_, name + "/filters", {side, side, in, out})),
                    bias(name, out)};
    return add("Convolution", params, {stride == 2 ? pad_end(from) : from});
  }
  // Convolves depthwise by 3x3, then pointwise (Howard et al. 2017, section 3.1).
  int separable(int from, const std::string& name, int in, int out, int stride = 1) {
    LayerParams deep = convolution_params(3, stride, stride == 1, in);
    LayerParams point = convolution_params(1, 1, 0, out);
    deep.set("group", in);
    deep.set("bias_term", false);
    WeightTensor depthwise = take_tensor(weights_, name + "/depthwise_filter", {3, 3, in, 1});
    depthwise.shape = {3, 3, 1, in};
    deep.blobs = {filters(depthwise)};
    point.blobs = {filters(take_tensor(weights_, name + "/pointwise_filter", {1, 1, in, out})),
                   bias(name, out)};
    return add("Convolution", point,
               {add("Convolution", deep, {stride == 2 ? pad_end(from) : from})});
  }
  // Adds four convolutions; each takes the sum of all before it.
  int dense_block(int from, const std::string& name, int in, int out) {
    const std::string conv = name + "/conv";
    int sum_so_far = relu(in == 3 ? convolution(from, conv + "0", 3, in, out, 2)
                                  : separable(from, conv + "0", in, out, 2));
    int last = sum_so_far;
    for (int k = 1; k < 4; k++) {
      sum_so_far = sum({sum_so_far, separable(last, conv + std::to_string(k), out, out)});
      last = relu(sum_so_far);
    }
    return last;
  }
  int full(int from, int in, int out) {
    const WeightTensor t = take_tensor(weights_, "fc/weights", {in, out});
    std::vector<float> values(t.values.size());
    for (int o = 0; o < out; o++)
      for (int i = 0; i < in; i++) values[size_t(o * in + i)] = t.values[size_t(i * out + o)];
    LayerParams params;
    params.set("num_output", out);
    params.blobs = {blob({out, in}, values), bias("fc", out)};
    return add("InnerProduct", params, {from});
  }
  cv::dnn::Net finish() {
    if (!weights_.tensors.empty())
      throw LoadError(weights_.file, weights_.tensors.begin()->first,
                      "the network has no place for this tensor");
    net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return net_;
  }

 private:
  static LayerParams convolution_params(int side, int stride, int rim, int out) {
    LayerParams params;
    params.set("kernel_size", side);
    params.set("stride", stride);
    params.set("pad", rim);
    params.set("num_output", out);
    params.set("bias_term", true);
    return params;
  }
  cv::Mat bias(const std::string& name, int out) {
    return blob({1, out}, take_tensor(weights_, name + "/bias", {out}).values);
  }

  cv::dnn::Net net_;
  WeightSet weights_;
  int count_ = 0;
};

}  // namespace

struct Network::Impl {
  cv::dnn::Net net;
  Means means;
  int side = 0;  // side of the input; 0: any multiple of detector_cell
};

Network::Network(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Network::Network(Network&&) noexcept = default;
Network::~Network() = default;

std::vector<float> Network::run(const NetworkInput& input) {
  Impl& m = *impl_;
  const bool fits = m.side
                        ? input.width == m.side && input.height == m.side
                        : input.width > 0 && input.height > 0 && input.width % detector_cell == 0 &&
                              input.height % detector_cell == 0;
  const size_t plane = size_t(input.width) * size_t(input.height);
  if (!fits || input.planes.size() != 3 * plane)
    throw std::invalid_argument("a network got a picture of another size");
  cv::Mat in({1, 3, input.height, input.width}, CV_32F);
  const float means[3] = {m.means.red, m.means.green, m.means.blue};
  for (size_t c = 0; c < 3; c++)
    for (size_t i = 0; i < plane; i++)
      in.ptr<float>()[c * plane + i] = (input.planes[c * plane + i] - means[c]) / 255;
  m.net.setInput(in);
  const cv::Mat out = m.net.forward();
  return {out.ptr<float>(), out.ptr<float>() + out.total()};
}

Network load_face_detector(const std::string& folder) {
  Builder b(load_weight_set(folder, "tiny_face_detector_model"));
  constexpr float slope = 0.1f;
  int last = b.relu(b.convolution(0, "conv0", 3, 3, 16, 1), slope);
  for (int k = 1, channels = 16; k <= 5; k++, channels *= 2) {
    last = b.max_pool(last, 2);
    last = b.separable(last, "conv" + std::to_string(k), channels, 2 * channels);
    last = b.relu(last, slope);
  }
  last = b.max_pool(last, 1);
  b.convolution(last, "conv8", 1, 512, 5 * detector_anchors, 1);
  return Network(
      std::make_unique<Network::Impl>(Network::Impl{b.finish(), {117.001f, 114.697f, 97.404f}, 0}));
}

static Network load_marks(const std::string& folder, const char* name, int outputs, bool softmax) {
  Builder b(load_weight_set(folder, name));
  int last = 0;
  for (int k = 0, in = 3, out = 32; k < 4; k++, in = out, out *= 2)
    last = b.dense_block(last, "dense" + std::to_string(k), in, out);
  LayerParams mean;
  mean.set("pool", "ave");
  mean.set("global_pooling", true);
  last = b.full(b.add("Pooling", mean, {last}), 256, outputs);
  if (softmax) b.add("Softmax", {}, {last});
  return Network(std::make_unique<Network::Impl>(
      Network::Impl{b.finish(), {122.782f, 117.001f, 104.298f}, marks_side}));
}

Network load_face_landmarks(const std::string& folder) {
  return load_marks(folder, "face_landmark_68_model", 2 * landmark_count, false);
}
Network load_face_expression(const std::string& folder) {
  return load_marks(folder, "face_expression_model", 7, true);
}

}  // namespace wellspring::kiosk
