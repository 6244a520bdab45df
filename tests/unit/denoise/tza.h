// SPDX-License-Identifier: Apache-2.0
// Writes files of weights as denoise/weights.h describes them.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace wellspring::test {

class TzaFile {
 public:
  // Values are exact in the type chosen: 'h' or 'f'.
  void add(const std::string& name, const std::vector<int>& sizes, const std::string& layout,
           char type, const std::vector<float>& values) {
    size_t offset = 12 + data_.size();
    for (float value : values) {
      if (type == 'f') append(data_, std::bit_cast<uint32_t>(value), 4);
      else append(data_, half_of(value), 2);
    }
    add_entry(name, sizes, layout, type, offset);
  }
  void add_halves(const std::string& name, const std::vector<int>& sizes, const std::string& layout,
                  const std::vector<uint16_t>& bits) {
    size_t offset = 12 + data_.size();
    for (uint16_t one : bits) append(data_, one, 2);
    add_entry(name, sizes, layout, 'h', offset);
  }
  size_t table_offset() const { return 12 + data_.size(); }
  std::vector<std::byte> bytes() const {
    std::vector<std::byte> all;
    append(all, 0x41d7, 2), append(all, 2, 1), append(all, 0, 1), append(all, table_offset(), 8);
    all.insert(all.end(), data_.begin(), data_.end());
    append(all, count_, 4);
    all.insert(all.end(), table_.begin(), table_.end());
    return all;
  }

 private:
  static void append(std::vector<std::byte>& to, uint64_t value, int bytes) {
    for (int i = 0; i < bytes; i++) to.push_back(std::byte(value >> (8 * i) & 255));
  }
  static uint16_t half_of(float value) {  // takes normal halves and 0
    uint32_t bits = std::bit_cast<uint32_t>(value);
    if (value == 0) return 0;
    return uint16_t((bits >> 16 & 0x8000) | (((bits >> 23 & 255) - 112) << 10) |
                    (bits >> 13 & 0x3ff));
  }
  void add_entry(const std::string& name, const std::vector<int>& sizes, const std::string& layout,
                 char type, size_t offset) {
    append(table_, name.size(), 2);
    for (char c : name) append(table_, uint8_t(c), 1);
    append(table_, sizes.size(), 1);
    for (int size : sizes) append(table_, uint32_t(size), 4);
    for (char c : layout) append(table_, uint8_t(c), 1);
    append(table_, uint8_t(type), 1);
    append(table_, offset, 8);
    count_++;
  }
  std::vector<std::byte> data_, table_;
  uint32_t count_ = 0;
};

}  // namespace wellspring::test
