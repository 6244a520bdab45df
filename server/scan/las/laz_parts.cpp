// SPDX-License-Identifier: Apache-2.0
#include "scan/las/laz_parts.h"

#include <algorithm>

#include "scan/las/las_bytes.h"

namespace wellspring::scan {

void RunningMedian::add(int32_t value) {
  auto& v = values_;
  if (replaces_largest_) {
    replaces_largest_ = value < v[2];
    int place = 4;
    for (; place > 0 && value < v[place - 1]; place--) v[place] = v[place - 1];
    v[place] = value;
  } else {
    replaces_largest_ = value <= v[2];
    int place = 0;
    for (; place < 4 && v[place + 1] < value; place++) v[place] = v[place + 1];
    v[place] = value;
  }
}

int32_t PlaceDecoder::read_dx(ArithmeticDecoder& decoder, RunningMedian& median, bool is_single) {
  const int32_t step = dx_.read(decoder, median.value(), is_single);
  median.add(step);
  return step;
}

int32_t PlaceDecoder::read_dy(ArithmeticDecoder& decoder, RunningMedian& median, bool is_single) {
  const uint32_t bits = std::min(dx_.last_bits() & ~1u, 20u);
  const int32_t step = dy_.read(decoder, median.value(), bits + is_single);
  median.add(step);
  return step;
}

int32_t PlaceDecoder::read_z(ArithmeticDecoder& decoder, int32_t predicted, bool is_single) {
  const uint32_t bits = std::min((dx_.last_bits() + dy_.last_bits()) / 2 & ~1u, 18u);
  return z_.read(decoder, predicted, bits + is_single);
}

namespace {
// Symbols of multiples: 0 to 500, then -1 to -10, then that nothing changes, a time far away, and
// three for the other sequences.
constexpr int32_t most_multiple = 500, least_multiple = -10;
constexpr int32_t same_symbol = most_multiple - least_multiple + 1, far_symbol = same_symbol + 1;
constexpr int32_t steps_until_kept = 3;      // so many extreme steps do not yet change the step
constexpr int most_changes_of_sequence = 8;  // an encoder needs one
}  // namespace

TimeDecoder::TimeDecoder(uint64_t first, bool knows_same)
    : knows_same_(knows_same),
      multiples_(far_symbol + 4 - !knows_same),
      beginnings_(knows_same ? 6 : 5) {
  sequences_[0].time = first;
}

uint64_t TimeDecoder::read(ArithmeticDecoder& decoder) {
  int left = most_changes_of_sequence;
  while (!(sequences_[current_].step == 0 ? read_without_step(decoder) : read_with_step(decoder)))
    if (left-- == 0) {
      decoder.set_damaged();
      break;
    }
  return sequences_[current_].time;
}

// A time far away begins a sequence in place of the oldest.
void TimeDecoder::read_far(ArithmeticDecoder& decoder) {
  const int32_t high = int32_t(sequences_[current_].time >> 32);
  newest_ = (newest_ + 1) % 4;
  const uint64_t new_high = uint32_t(differences_.read(decoder, high, 8));
  sequences_[newest_] = {new_high << 32 | decoder.read_bits(32)};
  current_ = newest_;
}

bool TimeDecoder::read_without_step(ArithmeticDecoder& decoder) {
  const uint32_t symbol = decoder.read_symbol(beginnings_) + !knows_same_;
  Sequence& sequence = sequences_[current_];
  if (symbol == 0) return true;
  if (symbol == 1) {
    sequence.step = differences_.read(decoder, 0, 0);
    sequence.time += uint64_t(int64_t(sequence.step));
    sequence.extremes = 0;
    return true;
  }
  if (symbol == 2) {
    read_far(decoder);
    return true;
  }
  current_ = (current_ + symbol - 2) % 4;
  return false;
}

bool TimeDecoder::read_with_step(ArithmeticDecoder& decoder) {
  int32_t symbol = int32_t(decoder.read_symbol(multiples_));
  if (!knows_same_ && symbol >= same_symbol) symbol++;
  if (symbol == same_symbol) return true;
  if (symbol == far_symbol) {
    read_far(decoder);
    return true;
  }
  if (symbol > far_symbol) {
    current_ = (current_ + uint32_t(symbol - far_symbol)) % 4;
    return false;
  }
  Sequence& sequence = sequences_[current_];
  const int32_t multiple = symbol <= most_multiple ? symbol : most_multiple - symbol;
  const int32_t step = read_multiple(decoder, multiple);
  sequence.time += uint64_t(int64_t(step));
  if (multiple == 1) sequence.extremes = 0;
  else if (multiple == 0 || multiple == most_multiple || multiple == least_multiple)
    if (++sequence.extremes > steps_until_kept) sequence.step = step, sequence.extremes = 0;
  return true;
}

int32_t TimeDecoder::read_multiple(ArithmeticDecoder& decoder, int32_t multiple) {
  uint32_t context = 1;
  if (multiple == 0) context = 7;
  else if (multiple == 1) context = 1;
  else if (multiple == most_multiple) context = 4;
  else if (multiple == least_multiple) context = 6;
  else if (multiple < 0) context = 5;
  else context = multiple < 10 ? 2 : 3;
  const uint32_t step = uint32_t(sequences_[current_].step);
  return differences_.read(decoder, int32_t(uint32_t(multiple) * step), context);
}

namespace {
uint8_t low_byte(int value) { return uint8_t(value & 0xff); }
int clamp_byte(int value) { return std::clamp(value, 0, 255); }
uint16_t join_bytes(int low, int high) { return uint16_t(low | high << 8); }
}  // namespace

LazColor ColorDecoder::read(ArithmeticDecoder& decoder, const LazColor& last) {
  const uint32_t changes = decoder.read_symbol(changes_);
  const auto last_byte = [&](int channel, int byte) { return last[channel] >> (8 * byte) & 0xff; };
  // Adds to a byte of a channel, moved by what other channels have changed.
  const auto read_byte = [&](int channel, int byte, int moved) {
    const int index = 2 * channel + byte;
    const int before = last_byte(channel, byte);
    if (!(changes >> index & 1)) return before;
    return int(low_byte(int(decoder.read_symbol(bytes_[index])) + clamp_byte(before + moved)));
  };
  const std::array<int, 2> red{read_byte(0, 0, 0), read_byte(0, 1, 0)};
  const uint16_t joined = join_bytes(red[0], red[1]);
  if (!(changes >> 6 & 1)) return {joined, joined, joined};
  std::array<int, 2> green{}, blue{};
  for (int byte = 0; byte < 2; byte++) {
    const int red_moved = red[byte] - last_byte(0, byte);
    green[byte] = read_byte(1, byte, red_moved);
    blue[byte] = read_byte(2, byte, (red_moved + green[byte] - last_byte(1, byte)) / 2);
  }
  return {joined, join_bytes(green[0], green[1]), join_bytes(blue[0], blue[1])};
}

void WaveDecoder::read(ArithmeticDecoder& decoder, const uint8_t* last, uint8_t* wave) {
  const auto last_number = [&](int at) { return las_number<int32_t>(last + at); };
  uint64_t offset = las_number<uint64_t>(last + 1);
  const uint8_t index = uint8_t(decoder.read_symbol(index_));
  last_kind_ = decoder.read_symbol(offsets_[last_kind_]);
  if (last_kind_ == 1) offset += las_number<uint32_t>(last + 9);
  if (last_kind_ == 2) {
    last_step_ = offset_step_.read(decoder, last_step_);
    offset += uint64_t(int64_t(last_step_));
  }
  if (last_kind_ == 3) offset = decoder.read_64_bits();
  const int32_t size = size_.read(decoder, last_number(9));
  const int32_t return_point = return_point_.read(decoder, last_number(13));
  std::array<int32_t, 3> direction{};
  for (int i = 0; i < 3; i++)
    direction[i] = direction_.read(decoder, last_number(17 + 4 * i), uint32_t(i));
  wave[0] = index;
  put_las_number(wave + 1, offset);
  put_las_number(wave + 9, size);
  put_las_number(wave + 13, return_point);
  for (int i = 0; i < 3; i++) put_las_number(wave + 17 + 4 * i, direction[i]);
}

}  // namespace wellspring::scan
