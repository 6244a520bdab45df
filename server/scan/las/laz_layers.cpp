// SPDX-License-Identifier: Apache-2.0
#include "scan/las/laz_layers.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "scan/las/las_bytes.h"
#include "scan/las/laz_parts.h"

namespace wellspring::scan {
namespace {

// Keeps a state for each channel that a chunk uses. A State has `last`, the item's bytes, and is
// made of them.
template <class State>
class ChannelStates {
 public:
  // Up to version 3 the last bytes are those of the channel before, unless the channel is new.
  ChannelStates(uint32_t channel, std::unique_ptr<State> state, bool mixes)
      : mixes_(mixes), current_(channel) {
    states_[channel] = std::move(state);
  }
  struct Chosen {
    State &models, &last;
  };
  Chosen choose(uint32_t channel) {
    State* last = states_[current_].get();
    if (channel != current_) {
      current_ = channel;
      const bool is_new = !states_[channel];
      if (is_new) states_[channel] = std::make_unique<State>(last->last);
      if (is_new || !mixes_) last = states_[channel].get();
    }
    return {*states_[current_], *last};
  }

 private:
  bool mixes_;
  uint32_t current_;
  std::array<std::unique_ptr<State>, 4> states_;
};

bool mixes_channels(const LazItem& item) { return item.version < 4; }

struct ColorState {
  std::array<uint16_t, 4> last;  // infrared comes last
  ColorDecoder colors;
  SymbolModel infrared_changes{4};
  std::vector<SymbolModel> infrared_bytes = make_models(2, 256);
  explicit ColorState(const std::array<uint16_t, 4>& first) : last(first) {}
};

class Color14 : public LayeredItem {
 public:
  Color14(const LazItem& item, const uint8_t* first, std::span<const LazLayer> layers,
          uint32_t channel)
      : size_(item.size),
        color_(layers[0]),
        infrared_(layers.size() > 1 ? OptionalStream(layers[1]) : OptionalStream()),
        states_(channel, std::make_unique<ColorState>(load_last(first, item.size)),
                mixes_channels(item)) {}
  void read(uint8_t* item, uint32_t& channel) override {
    auto [models, before] = states_.choose(channel);
    auto& last = before.last;
    if (color_.is_there) {
      const LazColor color = models.colors.read(color_.decoder, {last[0], last[1], last[2]});
      std::copy(color.begin(), color.end(), last.begin());
    }
    if (infrared_.is_there) last[3] = read_infrared(models, last[3]);
    std::memcpy(item, last.data(), size_);
  }
  bool is_damaged() const override { return color_.is_damaged() || infrared_.is_damaged(); }

 private:
  static std::array<uint16_t, 4> load_last(const uint8_t* first, size_t size) {
    std::array<uint16_t, 4> last{};
    std::memcpy(last.data(), first, size);
    return last;
  }
  uint16_t read_infrared(ColorState& models, uint16_t last) {
    ArithmeticDecoder& decoder = infrared_.decoder;
    const uint32_t changes = decoder.read_symbol(models.infrared_changes);
    uint32_t bytes[2] = {uint32_t(last & 0xff), uint32_t(last >> 8)};
    for (int i = 0; i < 2; i++)
      if (changes >> i & 1)
        bytes[i] = (bytes[i] + decoder.read_symbol(models.infrared_bytes[i])) & 0xff;
    return uint16_t(bytes[1] << 8 | bytes[0]);
  }

  size_t size_;
  OptionalStream color_, infrared_;
  ChannelStates<ColorState> states_;
};

struct WaveState {
  std::array<uint8_t, wave_bytes> last;
  WaveDecoder waves;
  explicit WaveState(const std::array<uint8_t, wave_bytes>& first) : last(first) {}
};

class Wave14 : public LayeredItem {
 public:
  Wave14(const LazItem& item, const uint8_t* first, LazLayer layer, uint32_t channel)
      : wave_(layer),
        states_(channel,
                std::make_unique<WaveState>(las_number<std::array<uint8_t, wave_bytes>>(first)),
                mixes_channels(item)) {}
  void read(uint8_t* item, uint32_t& channel) override {
    auto [models, before] = states_.choose(channel);
    uint8_t* last = before.last.data();
    if (wave_.is_there) models.waves.read(wave_.decoder, last, last);
    std::copy_n(last, wave_bytes, item);
  }
  bool is_damaged() const override { return wave_.is_damaged(); }

 private:
  OptionalStream wave_;
  ChannelStates<WaveState> states_;
};

struct BytesState {
  std::vector<uint8_t> last;
  std::vector<SymbolModel> models;
  explicit BytesState(std::vector<uint8_t> first)
      : last(std::move(first)), models(make_models(last.size(), 256)) {}
};

class Bytes14 : public LayeredItem {
 public:
  Bytes14(const LazItem& item, const uint8_t* first, std::span<const LazLayer> layers,
          uint32_t channel)
      : bytes_(layers.begin(), layers.end()),
        states_(channel,
                std::make_unique<BytesState>(std::vector<uint8_t>(first, first + item.size)),
                mixes_channels(item)) {}
  void read(uint8_t* item, uint32_t& channel) override {
    auto [models, before] = states_.choose(channel);
    for (size_t i = 0; i < bytes_.size(); i++) {
      if (bytes_[i].is_there)
        before.last[i] += uint8_t(bytes_[i].decoder.read_symbol(models.models[i]));
      item[i] = before.last[i];
    }
  }
  bool is_damaged() const override {
    return std::ranges::any_of(bytes_, [](const auto& stream) { return stream.is_damaged(); });
  }

 private:
  std::vector<OptionalStream> bytes_;
  ChannelStates<BytesState> states_;
};

}  // namespace

size_t layers_of(const LazItem& item) {
  if (item.kind == LazItemKind::point14) return point14_layers;
  if (item.kind == LazItemKind::color_infrared14) return 2;
  return item.kind == LazItemKind::bytes14 ? item.size : 1;
}

std::unique_ptr<LayeredItem> make_layered_item(const LazItem& item, const uint8_t* first,
                                               std::span<const LazLayer> layers,
                                               uint32_t& channel) {
  switch (item.kind) {
    case LazItemKind::point14: return make_point14(item, first, layers, channel);
    case LazItemKind::wave14: return std::make_unique<Wave14>(item, first, layers[0], channel);
    case LazItemKind::bytes14: return std::make_unique<Bytes14>(item, first, layers, channel);
    default: return std::make_unique<Color14>(item, first, layers, channel);
  }
}

}  // namespace wellspring::scan
