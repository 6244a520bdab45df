// SPDX-License-Identifier: Apache-2.0
#include "denoise/unet.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <dnnl.hpp>
#include <omp.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/task_arena.h>
#include <set>

#include "base/clock.h"
#include "base/load_error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "denoise/tile.h"

namespace wellspring::denoise {
namespace {

constexpr int levels = 5;      // full resolution and four halvings
constexpr int alignment = 16;  // sizes are padded to multiples of it, so that all halvings are even
// Pixels a side of a tile of each level, about: larger tiles repeat less, smaller ones fit caches
// and leave no core without work.
constexpr std::array<int, levels> tile_size = {192, 128, 96, 64, 48};

dnnl::memory::data_type type_of(const Format& format) {
  return format.bfloat16 ? dnnl::memory::data_type::bf16 : dnnl::memory::data_type::f32;
}
dnnl::memory::format_tag tag_of(const Format& format) {
  return format.block == 16 ? dnnl::memory::format_tag::nChw16c : dnnl::memory::format_tag::nChw8c;
}

// Holds the features of one level: planes of `block` channels, rows, pixels.
struct Features {
  int width = 0, height = 0, channels = 0;
  RawVector<std::byte> data;
};

constexpr int no_features = -1, the_input = -2;

// Says what a run of convolutions reads: features of its level, those of the level below enlarged,
// or the input.
struct Source {
  int features = no_features;
  bool enlarged = false;
  int channels = 0;  // as stored, in whole blocks
  int used = 0;      // channels that are in use
};

struct Layer {
  std::string name;
  int inputs = 0, outputs = 0;  // channels as stored
  dnnl::convolution_forward run;
  dnnl::memory::desc source, target, scratchpad;
  dnnl::memory weights, bias;
};

// Holds convolutions of one level whose features between them only exist as tiles.
struct Stage {
  int level = 0;
  std::vector<Source> sources;
  std::vector<Layer> layers;
  bool pools = false;
  int target = no_features;  // no_features: the output
  // These depend on the picture's size:
  int width = 0, height = 0, tile_width = 0, tile_height = 0, columns = 0, rows = 0;
};

struct Scratch {
  RawVector<std::byte> tile[2];
  RawVector<std::byte> pad;
  dnnl::stream stream;
};

}  // namespace

const char* unet_problem() {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    return "this processor has no AVX2";
#endif
  return nullptr;
}

struct UNet::Impl {
  Format format = best_format();
  dnnl::engine engine{dnnl::engine::kind::cpu, 0};
  Weights weights;
  std::vector<Stage> stages;
  std::vector<Features> features;
  const InputPixels* input = nullptr;
  int width = 0, height = 0;  // size of the picture, pixels
  RawVector<vec3> output;
  size_t stage = 0;
  int next_tile = 0;
  size_t tile_bytes = 0, pad_bytes = 0;
  oneapi::tbb::enumerable_thread_specific<Scratch> scratch;

  void add_stages(const std::vector<StageForm>& form, const std::string& path);
  void prepare(Stage& stage);
  void prepare_layer(Layer& layer, const Stage& stage, int width, int height);
  void gather(const Stage& stage, const Part& part, std::byte* to) const;
  void keep(const Stage& stage, const Part& part, const std::byte* from);
  void pool(const Stage& stage, const Part& part, const std::byte* from);
  void take_output(const Part& part, const std::byte* from);
  void compute_tile(const Stage& stage, int tile);
};

UNet::UNet(const Weights& weights, const std::string& path) : impl_(std::make_unique<Impl>()) {
  impl_->weights = weights;
  impl_->add_stages(weights.count("enc_conv0.weight") ? plain_form : large_form, path);
}
UNet::~UNet() = default;
UNet::UNet(UNet&&) noexcept = default;
UNet& UNet::operator=(UNet&&) noexcept = default;

void UNet::Impl::add_stages(const std::vector<StageForm>& form, const std::string& path) {
  std::set<std::string> used;
  auto find = [&](const std::string& name, const std::vector<int>& sizes) {
    auto found = weights.find(name);
    if (found == weights.end()) throw LoadError(path, name, "is missing");
    if (found->second.sizes != sizes) throw LoadError(path, name, "has another shape");
    used.insert(name);
  };
  auto outputs_of = [&](const std::string& layer) {
    auto found = weights.find(layer + ".weight");
    if (found == weights.end() || found->second.sizes.size() != 4)
      throw LoadError(path, layer + ".weight", "is missing");
    return found->second.sizes[0];
  };
  int pooled[levels] = {};  // pooled features by the level they belong to, and their used channels
  int channels[levels] = {};
  int before = the_input, before_channels = input_channels;
  for (const StageForm& of : form) {
    Stage stage;
    stage.level = of.level;
    stage.pools = of.pools;
    bool decodes = of.layers[0].starts_with("dec");
    stage.sources.push_back(
        {before, decodes, round_up(before_channels, format.block), before_channels});
    if (decodes) {
      int joined = of.level == 0 ? the_input : pooled[of.level];
      int joined_channels = of.level == 0 ? input_channels : channels[of.level];
      stage.sources.push_back(
          {joined, false, round_up(joined_channels, format.block), joined_channels});
    }
    int stored = 0, in = 0;
    for (const Source& source : stage.sources) stored += source.channels, in += source.used;
    for (const std::string& name : of.layers) {
      int out = outputs_of(name);
      find(name + ".weight", {out, in, 3, 3});
      find(name + ".bias", {out});
      Layer layer;
      layer.name = name;
      layer.inputs = stored;
      layer.outputs = round_up(out, format.block);
      stored = layer.outputs, in = out;
      stage.layers.push_back(std::move(layer));
    }
    if (of.level == 0 && decodes) {
      if (in != 3) throw LoadError(path, of.layers.back() + ".weight", "has another shape");
    } else {
      stage.target = int(features.size());
      features.push_back({0, 0, stored, {}});
      if (of.pools) pooled[of.level + 1] = stage.target, channels[of.level + 1] = in;
    }
    before = stage.target, before_channels = in;
    stages.push_back(std::move(stage));
  }
  for (const auto& [name, tensor] : weights)
    if (!used.count(name)) throw LoadError(path, name, "belongs to no layer of the network");
}

// Creates the convolution of a tile, and brings its weights into the form that it needs.
void UNet::Impl::prepare_layer(Layer& layer, const Stage& stage, int across, int down) {
  using dnnl::memory;
  const Tensor& from = weights.at(layer.name + ".weight");
  const Tensor& bias = weights.at(layer.name + ".bias");
  layer.source = memory::desc({1, layer.inputs, down, across}, type_of(format), tag_of(format));
  layer.target =
      memory::desc({1, layer.outputs, down - 2, across - 2}, type_of(format), tag_of(format));
  memory::desc any({layer.outputs, layer.inputs, 3, 3}, type_of(format), memory::format_tag::any);
  memory::desc bias_desc({layer.outputs}, memory::data_type::f32, memory::format_tag::x);
  dnnl::primitive_attr attributes;
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  // The network's last layer has its ReLU, too: radiance is not negative.
  dnnl::post_ops relu;
  const memory::dims one{1, 1}, none{0, 0};
#if DNNL_VERSION_MAJOR >= 3
  relu.append_eltwise(dnnl::algorithm::eltwise_relu, 0, 0);
  attributes.set_post_ops(relu);
  dnnl::convolution_forward::primitive_desc plan(
      engine, dnnl::prop_kind::forward_inference, dnnl::algorithm::convolution_direct, layer.source,
      any, bias_desc, layer.target, one, none, none, attributes);
#else
  relu.append_eltwise(1, dnnl::algorithm::eltwise_relu, 0, 0);
  attributes.set_post_ops(relu);
  dnnl::convolution_forward::primitive_desc plan(
      {dnnl::prop_kind::forward_inference, dnnl::algorithm::convolution_direct, layer.source, any,
       bias_desc, layer.target, one, none, none},
      attributes, engine);
#endif
  // Channels that only fill blocks have weight 0.
  memory plain(
      {{layer.outputs, layer.inputs, 3, 3}, memory::data_type::f32, memory::format_tag::oihw},
      engine);
  auto* filled = static_cast<float*>(plain.get_data_handle());
  std::fill(filled, filled + size_t(layer.outputs) * size_t(layer.inputs) * 9, 0.0f);
  bool first = &layer == &stage.layers[0];
  for (int o = 0; o < from.sizes[0]; o++) {
    int read = 0, stored = 0;
    auto copy = [&](int used, int room) {
      std::memcpy(filled + (size_t(o) * size_t(layer.inputs) + size_t(stored)) * 9,
                  &from.values[(size_t(o) * size_t(from.sizes[1]) + size_t(read)) * 9],
                  size_t(used) * 9 * sizeof(float));
      read += used, stored += room;
    };
    if (!first) copy(from.sizes[1], layer.inputs);
    else
      for (const Source& source : stage.sources) copy(source.used, source.channels);
  }
  layer.bias = memory(bias_desc, engine);
  auto* biases = static_cast<float*>(layer.bias.get_data_handle());
  std::fill(biases, biases + layer.outputs, 0.0f);
  std::copy(bias.values.begin(), bias.values.end(), biases);
  layer.weights = memory(plan.weights_desc(), engine);
  dnnl::stream stream(engine);
  dnnl::reorder(plain, layer.weights).execute(stream, plain, layer.weights);
  stream.wait();
  layer.scratchpad = plan.scratchpad_desc();
  layer.run = dnnl::convolution_forward(plan);
  pad_bytes = std::max(pad_bytes, layer.scratchpad.get_size());
}

void UNet::Impl::prepare(Stage& stage) {
  int across = round_up(width, alignment) >> stage.level;
  int down = round_up(height, alignment) >> stage.level;
  int side = tile_size[size_t(stage.level)];
  int tile_width = tile_extent(across, side), tile_height = tile_extent(down, side);
  stage.width = across, stage.height = down;
  stage.columns = (across + tile_width - 1) / tile_width;
  stage.rows = (down + tile_height - 1) / tile_height;
  int most = 0;
  if (tile_width != stage.tile_width || tile_height != stage.tile_height) {
    stage.tile_width = tile_width, stage.tile_height = tile_height;
    int beyond = 2 * int(stage.layers.size());
    for (Layer& layer : stage.layers) {
      prepare_layer(layer, stage, tile_width + beyond, tile_height + beyond);
      most = std::max({most, layer.inputs * (tile_width + beyond) * (tile_height + beyond),
                       layer.outputs * (tile_width + beyond - 2) * (tile_height + beyond - 2)});
      beyond -= 2;
    }
    tile_bytes = std::max(tile_bytes, size_t(most) * format.bytes());
  }
  if (stage.target == no_features) return;
  Features& target = features[size_t(stage.target)];
  target.width = stage.pools ? across / 2 : across;
  target.height = stage.pools ? down / 2 : down;
  target.data.resize(size_t(target.channels) * size_t(target.width) * size_t(target.height) *
                     format.bytes());
}

void UNet::Impl::gather(const Stage& stage, const Part& part, std::byte* to) const {
  const int block = format.block;
  const size_t element = format.bytes(), pixel = size_t(block) * element;
  const size_t plane = size_t(part.width) * size_t(part.height) * pixel;
  for (const Source& source : stage.sources)
    for (int first = 0; first < source.channels; first += block, to += plane) {
      if (source.features == the_input) {
        int count = std::clamp(input_channels - first, 0, block);
        copy_part(part, width, height, pixel, to, [&](int y, int x, int n, std::byte* row) {
          const uint16_t* from =
              input->data() + (size_t(y) * size_t(width) + size_t(x)) * input_channels + first;
          std::memset(row, 0, size_t(n) * pixel);
          for (int i = 0; i < n; i++, from += input_channels, row += pixel)
            for (int c = 0; c < count; c++)
              write_element(float(from[c]) * (1 / 65535.0f), format, row + size_t(c) * element);
        });
        continue;
      }
      const Features& of = features[size_t(source.features)];
      const std::byte* data =
          of.data.data() + size_t(first / block) * size_t(of.width) * size_t(of.height) * pixel;
      copy_part(part, stage.width, stage.height, pixel, to,
                [&](int y, int x, int n, std::byte* row) {
                  if (!source.enlarged) {
                    std::memcpy(row, data + (size_t(y) * size_t(of.width) + size_t(x)) * pixel,
                                size_t(n) * pixel);
                    return;
                  }
                  const std::byte* from = data + size_t(y / 2) * size_t(of.width) * pixel;
                  for (int i = 0; i < n; i++, row += pixel)
                    std::memcpy(row, from + size_t((x + i) / 2) * pixel, pixel);
                });
    }
}

// Takes the largest of 2x2 pixels' features, which are not negative: upper halves of floats as
// whole numbers, since the bits of such floats have their order.
template <class Element>
static void pool_row(const Element* upper, const Element* lower, int count, int block,
                     Element* to) {
  for (int x = 0; x < count; x++, upper += 2 * block, lower += 2 * block, to += block)
    for (int c = 0; c < block; c++)
      to[c] = std::max(std::max(upper[c], upper[c + block]), std::max(lower[c], lower[c + block]));
}

void UNet::Impl::pool(const Stage& stage, const Part& part, const std::byte* from) {
  Features& target = features[size_t(stage.target)];
  const size_t pixel = size_t(format.block) * format.bytes(), row = size_t(part.width) * pixel;
  int across = std::min(part.width, stage.width - part.left) / 2,
      down = std::min(part.height, stage.height - part.top) / 2;
  for (int block = 0; block < target.channels / format.block; block++) {
    std::byte* to =
        target.data.data() + size_t(block) * size_t(target.width) * size_t(target.height) * pixel;
    for (int y = 0; y < down; y++) {
      const std::byte* upper = from + (size_t(block) * size_t(part.height) + size_t(2 * y)) * row;
      std::byte* line =
          to + (size_t(part.top / 2 + y) * size_t(target.width) + size_t(part.left / 2)) * pixel;
      if (format.bfloat16)
        pool_row(reinterpret_cast<const int16_t*>(upper),
                 reinterpret_cast<const int16_t*>(upper + row), across, format.block,
                 reinterpret_cast<int16_t*>(line));
      else
        pool_row(reinterpret_cast<const float*>(upper), reinterpret_cast<const float*>(upper + row),
                 across, format.block, reinterpret_cast<float*>(line));
    }
  }
}

void UNet::Impl::keep(const Stage& stage, const Part& part, const std::byte* from) {
  Features& target = features[size_t(stage.target)];
  const size_t pixel = size_t(format.block) * format.bytes();
  int across = std::min(part.width, stage.width - part.left),
      down = std::min(part.height, stage.height - part.top);
  for (int block = 0; block < target.channels / format.block; block++)
    for (int y = 0; y < down; y++) {
      size_t to =
          (size_t(block) * size_t(target.height) + size_t(part.top + y)) * size_t(target.width) +
          size_t(part.left);
      size_t at = (size_t(block) * size_t(part.height) + size_t(y)) * size_t(part.width);
      std::memcpy(target.data.data() + to * pixel, from + at * pixel, size_t(across) * pixel);
    }
}

void UNet::Impl::take_output(const Part& part, const std::byte* from) {
  const size_t element = format.bytes(), pixel = size_t(format.block) * element;
  int across = std::min(part.width, width - part.left),
      down = std::min(part.height, height - part.top);
  for (int y = 0; y < down; y++) {
    const std::byte* row = from + size_t(y) * size_t(part.width) * pixel;
    vec3* to = &output[size_t(part.top + y) * size_t(width) + size_t(part.left)];
    for (int x = 0; x < across; x++, row += pixel)
      for (int c = 0; c < 3; c++) to[x][c] = read_element(row + size_t(c) * element, format);
  }
}

void UNet::Impl::compute_tile(const Stage& stage, int tile) {
  omp_set_num_threads(1);  // for this thread's calls of oneDNN
  Scratch& own = scratch.local();
  for (auto& buffer : own.tile) buffer.resize(tile_bytes);
  own.pad.resize(pad_bytes);
  if (!own.stream) own.stream = dnnl::stream(engine);
  const Part target{tile % stage.columns * stage.tile_width,
                    tile / stage.columns * stage.tile_height, stage.tile_width, stage.tile_height};
  int beyond = int(stage.layers.size());
  auto reaching = [&](int pixels) {
    return Part{target.left - pixels, target.top - pixels, target.width + 2 * pixels,
                target.height + 2 * pixels};
  };
  gather(stage, reaching(beyond), own.tile[0].data());
  for (const Layer& layer : stage.layers) {
    dnnl::memory from(layer.source, engine, own.tile[0].data());
    dnnl::memory to(layer.target, engine, own.tile[1].data());
    dnnl::memory pad(layer.scratchpad, engine, own.pad.data());
    layer.run.execute(own.stream, {{DNNL_ARG_SRC, from},
                                   {DNNL_ARG_WEIGHTS, layer.weights},
                                   {DNNL_ARG_BIAS, layer.bias},
                                   {DNNL_ARG_DST, to},
                                   {DNNL_ARG_SCRATCHPAD, pad}});
    own.stream.wait();
    std::swap(own.tile[0], own.tile[1]);
    if (--beyond > 0)
      clear_beyond(reaching(beyond), stage.width, stage.height, layer.outputs, format,
                   own.tile[0].data());
  }
  const std::byte* made = own.tile[0].data();
  if (stage.target == no_features) take_output(target, made);
  else if (stage.pools) pool(stage, target, made);
  else keep(stage, target, made);
}

void UNet::start(int width, int height, const InputPixels& input) {
  Impl& net = *impl_;
  omp_set_num_threads(1);  // oneDNN plans for as many threads as run it
  net.width = width, net.height = height;
  net.input = &input;
  net.output.resize(size_t(width) * size_t(height));
  for (Stage& stage : net.stages) net.prepare(stage);
  net.stage = 0;
  net.next_tile = 0;
}

bool UNet::advance(double seconds, const std::atomic<bool>* stop) {
  Impl& net = *impl_;
  double began = seconds_now();
  while (net.stage < net.stages.size()) {
    const Stage& stage = net.stages[net.stage];
    int all = stage.columns * stage.rows;
    int some = std::min(oneapi::tbb::this_task_arena::max_concurrency(), all - net.next_tile);
    parallel_each(some, [&](int i) { net.compute_tile(stage, net.next_tile + i); });
    net.next_tile += some;
    if (net.next_tile == all) net.stage++, net.next_tile = 0;
    if (seconds_now() - began >= seconds || (stop && *stop)) break;
  }
  return net.stage < net.stages.size();
}

const RawVector<vec3>& UNet::output() const { return impl_->output; }

size_t UNet::memory_bytes() const {
  const Impl& net = *impl_;
  size_t sum = bytes_of(net.output);
  for (const Features& of : net.features) sum += bytes_of(of.data);
  for (const auto& [name, tensor] : net.weights) sum += bytes_of(tensor.values);
  for (const Stage& stage : net.stages)
    for (const Layer& layer : stage.layers)
      if (layer.weights) sum += layer.weights.get_desc().get_size();
  for (const Scratch& own : net.scratch) sum += bytes_of(own.tile[0], own.tile[1], own.pad);
  return sum;
}

double UNet::operations() const {
  double sum = 0;
  for (const Stage& stage : impl_->stages)
    for (const Layer& layer : stage.layers)
      sum += 2.0 * double(impl_->weights.at(layer.name + ".weight").values.size()) *
             double(stage.width) * double(stage.height);
  return sum;
}

std::string UNet::implementation() const {
  std::set<std::string> names;
  for (const Stage& stage : impl_->stages)
    for (const Layer& layer : stage.layers) {
      const char* name = nullptr;
      if (layer.run &&
          dnnl_primitive_desc_query(layer.run.get_primitive_desc(), dnnl_query_impl_info_str, 0,
                                    &name) == dnnl_success &&
          name)
        names.insert(name);
    }
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

}  // namespace wellspring::denoise
