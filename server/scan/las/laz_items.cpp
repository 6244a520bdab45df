// SPDX-License-Identifier: Apache-2.0
#include "scan/las/laz_items.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <vector>

#include "scan/las/las_bytes.h"
#include "scan/las/laz_parts.h"

namespace wellspring::scan {
namespace {

constexpr int point10_bytes = 20;
// A record's bytes, from its beginning.
constexpr int at_x = 0, at_y = 4, at_z = 8, at_intensity = 12, at_returns = 14, at_class = 15,
              at_angle = 16, at_user = 17, at_source = 18;

void add_to_number(uint8_t* at, int32_t step) {
  put_las_number(at, add_wrapped(las_number<int32_t>(at), step));
}

// The bytes that both versions code alike.
struct Point10Rest {
  // Each has a model for each value that the byte had before.
  std::vector<SymbolModel> returns = make_models(256, 256), classes = make_models(256, 256),
                           user = make_models(256, 256);
  IntegerDecoder intensity, source{16};
  SymbolModel changes{64};
  std::array<uint8_t, point10_bytes> last;

  Point10Rest(const uint8_t* first, uint32_t intensity_contexts)
      : intensity(16, intensity_contexts) {
    std::copy_n(first, point10_bytes, last.begin());
  }
  void read_byte(ArithmeticDecoder& decoder, std::vector<SymbolModel>& models, int at) {
    last[at] = uint8_t(decoder.read_symbol(models[last[at]]));
  }
  void read_source(ArithmeticDecoder& decoder) {
    const uint16_t before = las_number<uint16_t>(&last[at_source]);
    put_las_number(&last[at_source], uint16_t(source.read(decoder, before)));
  }
  void copy_to(uint8_t* item) const { std::copy(last.begin(), last.end(), item); }
};

int32_t median_of(const std::array<int32_t, 3>& v) {
  return std::max(std::min(v[0], v[1]), std::min(std::max(v[0], v[1]), v[2]));
}

class Point10First : public PointwiseItem {
 public:
  explicit Point10First(const uint8_t* first) : rest_(first, 1) {}
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    auto& last = rest_.last;
    const int32_t dx = dx_.read(decoder, median_of(last_dx_));
    add_to_number(&last[at_x], dx);
    uint32_t bits = dx_.last_bits();
    const int32_t dy = dy_.read(decoder, median_of(last_dy_), std::min(bits, 19u));
    add_to_number(&last[at_y], dy);
    bits = (bits + dy_.last_bits()) / 2;
    const int32_t z = las_number<int32_t>(&last[at_z]);
    put_las_number(&last[at_z], z_.read(decoder, z, std::min(bits, 19u)));
    if (const uint32_t changes = decoder.read_symbol(rest_.changes))
      read_changes(decoder, changes, bits < 3);
    last_dx_[oldest_] = dx, last_dy_[oldest_] = dy;
    oldest_ = (oldest_ + 1) % 3;
    rest_.copy_to(item);
  }

 private:
  void read_changes(ArithmeticDecoder& decoder, uint32_t changes, bool is_near) {
    auto& last = rest_.last;
    if (changes & 32) {
      const uint16_t before = las_number<uint16_t>(&last[at_intensity]);
      put_las_number(&last[at_intensity], uint16_t(rest_.intensity.read(decoder, before)));
    }
    if (changes & 16) rest_.read_byte(decoder, rest_.returns, at_returns);
    if (changes & 8) rest_.read_byte(decoder, rest_.classes, at_class);
    if (changes & 4) last[at_angle] = uint8_t(angle_.read(decoder, last[at_angle], is_near));
    if (changes & 2) rest_.read_byte(decoder, rest_.user, at_user);
    if (changes & 1) rest_.read_source(decoder);
  }

  Point10Rest rest_;
  IntegerDecoder dx_{32}, dy_{32, 20}, z_{32, 20}, angle_{8, 2};
  std::array<int32_t, 3> last_dx_{}, last_dy_{};
  int oldest_ = 0;
};

// Returns a context of 16 for the return's number and how many there are. A table of LASzip, which
// also has places for numbers that make no sense.
constexpr uint8_t return_context[8][8] = {
    {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},
    {13, 1, 2, 4, 7, 11, 11, 10},    {12, 3, 4, 5, 8, 12, 12, 11},
    {11, 6, 7, 8, 9, 13, 13, 12},    {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15}};

class Point10Second : public PointwiseItem {
 public:
  explicit Point10Second(const uint8_t* first) : rest_(first, 4) {
    put_las_number(&rest_.last[at_intensity], uint16_t(0));
  }
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    auto& last = rest_.last;
    const uint32_t changes = decoder.read_symbol(rest_.changes);
    if (changes & 32) rest_.read_byte(decoder, rest_.returns, at_returns);
    const int number = last[at_returns] & 7, count = last[at_returns] >> 3 & 7;
    const int kind = return_context[count][number], level = std::abs(count - number);
    if (changes) read_changes(decoder, changes, kind);
    const bool is_single = count == 1;
    add_to_number(&last[at_x], places_.read_dx(decoder, dx_medians_[kind], is_single));
    add_to_number(&last[at_y], places_.read_dy(decoder, dy_medians_[kind], is_single));
    last_z_[level] = places_.read_z(decoder, last_z_[level], is_single);
    put_las_number(&last[at_z], last_z_[level]);
    rest_.copy_to(item);
  }

 private:
  void read_changes(ArithmeticDecoder& decoder, uint32_t changes, int kind) {
    auto& last = rest_.last;
    if (changes & 16)
      last_intensity_[kind] = uint16_t(
          rest_.intensity.read(decoder, last_intensity_[kind], uint32_t(std::min(kind, 3))));
    put_las_number(&last[at_intensity], last_intensity_[kind]);
    if (changes & 8) rest_.read_byte(decoder, rest_.classes, at_class);
    if (changes & 4)
      last[at_angle] += uint8_t(decoder.read_symbol(angles_[last[at_returns] >> 6 & 1]));
    if (changes & 2) rest_.read_byte(decoder, rest_.user, at_user);
    if (changes & 1) rest_.read_source(decoder);
  }

  Point10Rest rest_;
  PlaceDecoder places_;
  std::vector<SymbolModel> angles_ = make_models(2, 256);  // by the direction of scanning
  std::array<RunningMedian, 16> dx_medians_, dy_medians_;
  std::array<uint16_t, 16> last_intensity_{};
  std::array<int32_t, 8> last_z_{};
};

class Time11First : public PointwiseItem {
 public:
  explicit Time11First(const uint8_t* first) : time_(las_number<uint64_t>(first)) {}
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    if (step_ == 0) {
      const uint32_t kind = decoder.read_symbol(beginnings_);
      if (kind == 1) step_ = differences_.read(decoder, 0, 0), time_ += uint64_t(int64_t(step_));
      if (kind == 2) time_ = decoder.read_64_bits();
    } else {
      const int32_t multiple = int32_t(decoder.read_symbol(multiples_));
      if (multiple < most_multiples - 2) time_ += uint64_t(int64_t(read_step(decoder, multiple)));
      else if (multiple == most_multiples - 2) time_ = decoder.read_64_bits();
    }
    put_las_number(item, time_);
  }

 private:
  static constexpr int32_t most_multiples = 512;
  int32_t read_step(ArithmeticDecoder& decoder, int32_t multiple) {
    const bool is_least = multiple == 0, is_most = multiple == most_multiples - 3;
    const int32_t predicted = is_least ? step_ / 4 : int32_t(uint32_t(multiple) * uint32_t(step_));
    uint32_t context = multiple < 10 ? 3 : multiple < 50 ? 4 : 5;
    if (multiple < 2) context = is_least ? 2 : 1;
    const int32_t step = differences_.read(decoder, predicted, context);
    if (is_least || is_most) extremes_++;
    if (multiple == 1 || extremes_ > 3) step_ = step, extremes_ = 0;
    return step;
  }

  SymbolModel multiples_{most_multiples}, beginnings_{3};
  IntegerDecoder differences_{32, 6};
  uint64_t time_;
  int32_t step_ = 0, extremes_ = 0;
};

class Time11Second : public PointwiseItem {
 public:
  explicit Time11Second(const uint8_t* first) : times_(las_number<uint64_t>(first), true) {}
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    put_las_number(item, times_.read(decoder));
  }

 private:
  TimeDecoder times_;
};

class Color12First : public PointwiseItem {
 public:
  explicit Color12First(const uint8_t* first) { std::copy_n(first, 6, last_.begin()); }
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    const uint32_t changes = decoder.read_symbol(changes_);
    for (uint32_t i = 0; i < 6; i++)
      if (changes >> i & 1) last_[i] = uint8_t(bytes_.read(decoder, last_[i], i));
    std::copy(last_.begin(), last_.end(), item);
  }

 private:
  SymbolModel changes_{64};
  IntegerDecoder bytes_{8, 6};
  std::array<uint8_t, 6> last_;
};

class Color12Second : public PointwiseItem {
 public:
  explicit Color12Second(const uint8_t* first) : last_(las_number<LazColor>(first)) {}
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    last_ = colors_.read(decoder, last_);
    put_las_number(item, last_);
  }

 private:
  ColorDecoder colors_;
  LazColor last_;
};

class Wave13 : public PointwiseItem {
 public:
  explicit Wave13(const uint8_t* first) { std::copy_n(first, wave_bytes, last_.begin()); }
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    waves_.read(decoder, last_.data(), last_.data());
    std::copy(last_.begin(), last_.end(), item);
  }

 private:
  WaveDecoder waves_;
  std::array<uint8_t, wave_bytes> last_;
};

class BytesFirst : public PointwiseItem {
 public:
  BytesFirst(const uint8_t* first, size_t size) : last_(first, first + size), bytes_(8, size) {}
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    for (size_t i = 0; i < last_.size(); i++)
      item[i] = last_[i] = uint8_t(bytes_.read(decoder, last_[i], uint32_t(i)));
  }

 private:
  std::vector<uint8_t> last_;
  IntegerDecoder bytes_;
};

class BytesSecond : public PointwiseItem {
 public:
  BytesSecond(const uint8_t* first, size_t size)
      : last_(first, first + size), models_(make_models(size, 256)) {}
  void read(ArithmeticDecoder& decoder, uint8_t* item) override {
    for (size_t i = 0; i < last_.size(); i++)
      item[i] = last_[i] += uint8_t(decoder.read_symbol(models_[i]));
  }

 private:
  std::vector<uint8_t> last_;
  std::vector<SymbolModel> models_;
};

// Size and versions of an item that can be decoded; size 0: any but none.
struct KnownItem {
  LazItemKind kind;
  uint16_t size, first_version, last_version;
};
constexpr KnownItem known_items[] = {
    {LazItemKind::bytes, 0, 1, 2},           {LazItemKind::point10, point10_bytes, 1, 2},
    {LazItemKind::time11, 8, 1, 2},          {LazItemKind::color12, 6, 1, 2},
    {LazItemKind::wave13, wave_bytes, 1, 1}, {LazItemKind::point14, 30, 2, 4},
    {LazItemKind::color14, 6, 2, 4},         {LazItemKind::color_infrared14, 8, 2, 4},
    {LazItemKind::wave14, wave_bytes, 3, 4}, {LazItemKind::bytes14, 0, 2, 4},
};

}  // namespace

std::string find_fault(const LazItem& item) {
  for (const KnownItem& known : known_items) {
    if (known.kind != item.kind) continue;
    if (known.size == 0 ? item.size == 0 : item.size != known.size)
      return fmt::format("an item of kind {} has {} bytes", int(item.kind), item.size);
    if (item.version >= known.first_version && item.version <= known.last_version) return "";
    return fmt::format("version {} of the item of kind {} is not known", item.version,
                       int(item.kind));
  }
  return fmt::format("an item is of kind {}, which is not known", int(item.kind));
}

std::unique_ptr<PointwiseItem> make_pointwise_item(const LazItem& item, const uint8_t* first) {
  const bool is_first = item.version == 1;
  switch (item.kind) {
    case LazItemKind::point10:
      if (is_first) return std::make_unique<Point10First>(first);
      return std::make_unique<Point10Second>(first);
    case LazItemKind::time11:
      if (is_first) return std::make_unique<Time11First>(first);
      return std::make_unique<Time11Second>(first);
    case LazItemKind::color12:
      if (is_first) return std::make_unique<Color12First>(first);
      return std::make_unique<Color12Second>(first);
    case LazItemKind::wave13: return std::make_unique<Wave13>(first);
    default:
      if (is_first) return std::make_unique<BytesFirst>(first, item.size);
      return std::make_unique<BytesSecond>(first, item.size);
  }
}

}  // namespace wellspring::scan
