// SPDX-License-Identifier: Apache-2.0
#include "scan/las/laz_point14.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "scan/las/las_bytes.h"
#include "scan/las/laz_parts.h"

namespace wellspring::scan {
namespace {

// The fields of a record of point format 6.
struct Point14 {
  std::array<int32_t, 3> place{};
  uint16_t intensity = 0, source = 0;
  int16_t angle = 0;
  uint8_t number = 0, count = 0;  // the return, and how many there are, 0 to 15
  uint8_t flags = 0;              // 4 bits of the class, then direction and edge
  uint8_t channel = 0, classification = 0, user = 0;
  uint64_t time = 0;
  bool time_changed = false;  // since the channel's point before; is not in the record
};

Point14 load_point14(const uint8_t* from) {
  Point14 point;
  point.place = las_number<std::array<int32_t, 3>>(from);
  point.intensity = las_number<uint16_t>(from + 12);
  point.number = from[14] & 15, point.count = from[14] >> 4;
  point.flags = uint8_t((from[15] & 15) | (from[15] >> 6 << 4));
  point.channel = from[15] >> 4 & 3;
  point.classification = from[16], point.user = from[17];
  point.angle = las_number<int16_t>(from + 18);
  point.source = las_number<uint16_t>(from + 20);
  point.time = las_number<uint64_t>(from + 22);
  return point;
}

void put_point14(const Point14& point, uint8_t* to) {
  put_las_number(to, point.place);
  put_las_number(to + 12, point.intensity);
  to[14] = uint8_t(point.number | point.count << 4);
  to[15] = uint8_t((point.flags & 15) | point.channel << 4 | (point.flags >> 4 << 6));
  to[16] = point.classification, to[17] = point.user;
  put_las_number(to + 18, point.angle);
  put_las_number(to + 20, point.source);
  put_las_number(to + 22, point.time);
}

// Returns which of 6 kinds a return is, by its number and by how many there are. The rule of
// LASzip's table, which has places for numbers that make no sense.
constexpr int kind_of_return(int number, int count) {
  const int low = std::min(number, count), high = std::max(number, count);
  if (low == 0) return high < 6 ? high : high == 6 ? 3 : high < 9 ? 4 : 5;
  if (low == 1) return high == 1 ? 0 : high == 2 ? 1 : 3;
  if (low == 2) return high == 2 ? 2 : high < 11 ? 4 : 3;
  return high == low || (low > 10 && high == low + 1) ? 5 : 4;
}

constexpr auto kinds_of_return = [] {
  std::array<std::array<uint8_t, 16>, 16> kinds{};
  for (int count = 0; count < 16; count++)
    for (int number = 0; number < 16; number++)
      kinds[count][number] = uint8_t(kind_of_return(number, count));
  return kinds;
}();

// The models of a channel, and its last point.
struct Point14State {
  Point14 last;
  std::vector<SymbolModel> changes = make_models(8, 128);
  SymbolModel channels{3}, numbers_at_same_time{13};
  std::vector<SymbolModel> counts = make_models(16, 16), numbers = make_models(16, 16);
  PlaceDecoder places;
  std::array<RunningMedian, 12> dx_medians, dy_medians;
  std::array<int32_t, 8> last_z;
  std::vector<SymbolModel> classes = make_models(64, 256), flags = make_models(64, 64),
                           user = make_models(64, 256);
  IntegerDecoder intensity{16, 4}, angle{16, 2}, source{16};
  std::array<uint16_t, 8> last_intensity;
  TimeDecoder times;

  explicit Point14State(const Point14& first) : last(first), times(first.time, false) {
    last.time_changed = false;
    last_z.fill(first.place[2]);
    last_intensity.fill(first.intensity);
  }
};

class PlaceItem : public LayeredItem {
 public:
  PlaceItem(const LazItem& item, const uint8_t* first, std::span<const LazLayer> layers,
            uint32_t& channel)
      : tells_channel_always_(item.version >= 4) {
    for (size_t i = 0; i < point14_layers; i++) streams_[i] = OptionalStream(layers[i]);
    const Point14 point = load_point14(first);
    channel = current_ = point.channel;
    states_[current_] = std::make_unique<Point14State>(point);
  }

  void read(uint8_t* item, uint32_t& channel) override {
    ArithmeticDecoder& decoder = streams_[places].decoder;
    const Point14State& before = *states_[current_];
    const int kind_before = int(before.last.number == 1) |
                            int(before.last.number >= before.last.count) << 1 |
                            int(before.last.time_changed) << 2;
    const uint32_t changes = decoder.read_symbol(states_[current_]->changes[kind_before]);
    if (changes & 64) change_channel();
    // Up to version 3 other items hear of the channel only when it changes.
    if (changes & 64 || tells_channel_always_) channel = current_;
    Point14State& state = *states_[current_];
    state.last.time_changed = changes >> 4 & 1;
    read_returns(state, changes);
    read_place(state);
    read_rest(state, changes);
    put_point14(state.last, item);
  }

  bool is_damaged() const override {
    return std::ranges::any_of(streams_, [](const auto& stream) { return stream.is_damaged(); });
  }

 private:
  enum Layer { places, heights, classes, flags, intensities, angles, user, sources, times };

  void change_channel() {
    Point14State& before = *states_[current_];
    current_ = (current_ + streams_[places].decoder.read_symbol(before.channels) + 1) % 4;
    if (!states_[current_]) states_[current_] = std::make_unique<Point14State>(before.last);
    states_[current_]->last.channel = uint8_t(current_);
  }

  void read_returns(Point14State& state, uint32_t changes) {
    ArithmeticDecoder& decoder = streams_[places].decoder;
    Point14& last = state.last;
    if (changes & 4) last.count = uint8_t(decoder.read_symbol(state.counts[last.count]));
    const uint32_t kind = changes & 3, before = last.number;
    uint32_t number = before;
    if (kind == 1) number = before + 1;
    if (kind == 2) number = before + 15;
    if (kind == 3 && last.time_changed) number = decoder.read_symbol(state.numbers[before]);
    if (kind == 3 && !last.time_changed)
      number = before + 2 + decoder.read_symbol(state.numbers_at_same_time);
    last.number = uint8_t(number % 16);
  }

  void read_place(Point14State& state) {
    ArithmeticDecoder& decoder = streams_[places].decoder;
    Point14& last = state.last;
    const bool is_single = last.count == 1;
    const int kind = kinds_of_return[last.count][last.number] * 2 + last.time_changed;
    const int32_t dx = state.places.read_dx(decoder, state.dx_medians[kind], is_single);
    last.place[0] = add_wrapped(last.place[0], dx);
    const int32_t dy = state.places.read_dy(decoder, state.dy_medians[kind], is_single);
    last.place[1] = add_wrapped(last.place[1], dy);
    if (!streams_[heights].is_there) return;
    int32_t& last_z = state.last_z[std::min(std::abs(last.count - last.number), 7)];
    last_z = state.places.read_z(streams_[heights].decoder, last_z, is_single);
    last.place[2] = last_z;
  }

  void read_rest(Point14State& state, uint32_t changes) {
    Point14& last = state.last;
    const auto has = [&](Layer layer) { return streams_[layer].is_there; };
    const auto decoder = [&](Layer layer) -> ArithmeticDecoder& { return streams_[layer].decoder; };
    // 3: the only return, 2: the first of several, 1: the last, 0: one between.
    const int order = int(last.number == 1) << 1 | int(last.number >= last.count);
    if (has(classes)) {
      const int context = (last.classification & 31) << 1 | int(order == 3);
      last.classification = uint8_t(decoder(classes).read_symbol(state.classes[context]));
    }
    if (has(flags)) last.flags = uint8_t(decoder(flags).read_symbol(state.flags[last.flags]));
    if (has(intensities)) {
      uint16_t& intensity = state.last_intensity[order << 1 | int(last.time_changed)];
      intensity = uint16_t(state.intensity.read(decoder(intensities), intensity, uint32_t(order)));
      last.intensity = intensity;
    }
    if (has(angles) && changes & 8)
      last.angle = int16_t(state.angle.read(decoder(angles), last.angle, last.time_changed));
    if (has(user)) last.user = uint8_t(decoder(user).read_symbol(state.user[last.user / 4]));
    if (has(sources) && changes & 32)
      last.source = uint16_t(state.source.read(decoder(sources), last.source));
    if (has(times) && last.time_changed) last.time = state.times.read(decoder(times));
  }

  bool tells_channel_always_;
  uint32_t current_ = 0;
  std::array<OptionalStream, point14_layers> streams_;
  std::array<std::unique_ptr<Point14State>, 4> states_;
};

}  // namespace

std::unique_ptr<LayeredItem> make_point14(const LazItem& item, const uint8_t* first,
                                          std::span<const LazLayer> layers, uint32_t& channel) {
  return std::make_unique<PlaceItem>(item, first, layers, channel);
}

}  // namespace wellspring::scan
