// SPDX-License-Identifier: Apache-2.0
// Whole numbers in binary messages, byte by byte, so that the layout is little-endian on every
// machine and no pointer need be aligned; and what every binary message has in common: four bytes
// that name its kind, and the length of its header.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace wellspring::wire {

template <class T>
void put(std::span<uint8_t> bytes, size_t at, T value) {
  for (size_t i = 0; i < sizeof(T); i++) bytes[at + i] = uint8_t(uint64_t(value) >> (8 * i));
}

template <class T>
T get(std::span<const uint8_t> bytes, size_t at) {
  uint64_t value = 0;
  for (size_t i = 0; i < sizeof(T); i++) value |= uint64_t(bytes[at + i]) << (8 * i);
  return T(value);
}

using Magic = std::array<uint8_t, 4>;
inline constexpr size_t header_length_at = 26;  // u16

inline void put_envelope(std::span<uint8_t> bytes, const Magic& magic, size_t header_bytes) {
  std::copy(magic.begin(), magic.end(), bytes.begin());
  put(bytes, header_length_at, uint16_t(header_bytes));
}

// What follows the header of a message of that kind, whose header is at least as long as `least`
// (longer: a later version's, whose additions are skipped); none: it is no such message.
inline std::optional<std::span<const uint8_t>> get_payload(std::span<const uint8_t> bytes,
                                                           const Magic& magic, size_t least) {
  if (bytes.size() < least || !std::equal(magic.begin(), magic.end(), bytes.begin()))
    return std::nullopt;
  const size_t header_bytes = get<uint16_t>(bytes, header_length_at);
  if (header_bytes < least || header_bytes > bytes.size()) return std::nullopt;
  return bytes.subspan(header_bytes);
}

}  // namespace wellspring::wire
