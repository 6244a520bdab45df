// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/draw_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "base/parallel.h"

namespace wellspring::scan {
namespace {

constexpr int digit_bits = 11, digits = 1 << digit_bits;
constexpr size_t keys_a_part = 1 << 15;

// Sorts by one digit. Parts of the keys count their digits, so each knows where its keys go.
void sort_by_digit(std::vector<DrawnKey>& to, const std::vector<DrawnKey>& from, int shift) {
  const size_t parts = (from.size() + keys_a_part - 1) / keys_a_part;
  std::vector<std::array<uint32_t, digits>> places(parts);
  const auto each_key = [&](int part, const auto& body) {
    const size_t begin = size_t(part) * keys_a_part;
    const size_t end = std::min(from.size(), begin + keys_a_part);
    for (size_t i = begin; i < end; i++)
      body(from[i], places[size_t(part)][from[i].depth >> shift & (digits - 1)]);
  };
  parallel_each(int(parts), [&](int part) {
    places[size_t(part)].fill(0);
    each_key(part, [](const DrawnKey&, uint32_t& place) { place++; });
  });
  uint32_t sum = 0;
  for (int digit = 0; digit < digits; digit++)
    for (auto& part : places) sum += std::exchange(part[size_t(digit)], sum);
  parallel_each(int(parts), [&](int part) {
    each_key(part, [&](const DrawnKey& key, uint32_t& place) { to[place++] = key; });
  });
}

}  // namespace

void sort_by_depth(std::vector<DrawnKey>& keys, std::vector<DrawnKey>& spare) {
  uint32_t low = ~0u, high = 0;
  for (const DrawnKey& key : keys) low = std::min(low, key.depth), high = std::max(high, key.depth);
  if (low >= high) return;
  const int shift = std::max(0, int(std::bit_width(high - low)) - 2 * digit_bits);
  for (DrawnKey& key : keys) key.depth = (key.depth - low) >> shift;
  spare.resize(keys.size());
  sort_by_digit(spare, keys, 0);
  sort_by_digit(keys, spare, digit_bits);
}

}  // namespace wellspring::scan
