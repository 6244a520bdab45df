// SPDX-License-Identifier: Apache-2.0
// The bytes of a file of points, and the numbers in them, which are little-endian at any address.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "base/layers.h"

namespace wellspring::scan {

static_assert(std::endian::native == std::endian::little);

template <class Value>
Value las_number(const uint8_t* from) {
  Value value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class Value>
void put_las_number(uint8_t* to, Value value) {
  std::memcpy(to, &value, sizeof value);
}

// A file's bytes, which are read from the disk as they are looked at. Nobody may make the file
// shorter meanwhile.
class MappedFile {
 public:
  // Throws LoadError if it cannot be read or is no regular file.
  explicit MappedFile(const std::string& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::span<const uint8_t> bytes() const { return bytes_; }

 private:
  std::span<const uint8_t> bytes_;
};

}  // namespace wellspring::scan
