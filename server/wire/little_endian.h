// SPDX-License-Identifier: Apache-2.0
// Whole numbers in binary messages, byte by byte, so that the layout is little-endian on every
// machine and no pointer need be aligned.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace wellspring {

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

}  // namespace wellspring
