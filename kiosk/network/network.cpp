// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/network.h"

#include <opencv2/dnn.hpp>
#include <stdexcept>
#include <utility>

#include "base/load_error.h"
#include "kiosk/network/weights.h"

namespace wellspring::kiosk {

namespace {

using cv::dnn::LayerParams;

struct Means {
  float red, green, blue;
};

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
    params.blobs = {blob(filters(take_tensor(weights_, name + "/filters", {side, side, in, out}))),
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
    deep.blobs = {blob(filters(depthwise))};
    point.blobs = {
        blob(filters(take_tensor(weights_, name + "/pointwise_filter", {1, 1, in, out}))),
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
    WeightTensor matrix = take_tensor(weights_, "fc/weights", {in, out});
    matrix.shape = {1, 1, in, out};
    matrix = filters(matrix);
    matrix.shape = {out, in};
    LayerParams params;
    params.set("num_output", out);
    params.blobs = {blob(matrix), bias("fc", out)};
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
    return blob({{1, out}, take_tensor(weights_, name + "/bias", {out}).values});
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
