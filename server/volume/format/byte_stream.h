// SPDX-License-Identifier: Apache-2.0
// Reads a file's bytes in order, as they are or unpacked, and never more than was asked for.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "volume/format/stored_volume.h"

namespace wellspring::volume {

// Numbers of either byte order.
template <class Value>
Value number_at(const std::byte* from, bool is_swapped) {
  std::byte bytes[sizeof(Value)];
  for (size_t i = 0; i < sizeof(Value); i++)
    bytes[i] = from[is_swapped ? sizeof(Value) - 1 - i : i];
  Value value;
  __builtin_memcpy(&value, bytes, sizeof value);
  return value;
}

class ByteStream {
 public:
  // Begins at a byte of the file. With Packing::deflate that is where gzip or zlib begins; members
  // of gzip that follow each other are one stream. Throws LoadError if the file cannot be read.
  ByteStream(const std::string& file, uint64_t begin, Packing packing);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  // Reads up to `count` bytes, and fewer only at the end of the stream. Throws LoadError if packed
  // data are damaged.
  uint64_t read(std::byte* to, uint64_t count);
  // The same, and keeps none of them.
  uint64_t skip(uint64_t count);
  // Says whether the file ended within packed data.
  bool is_cut_off() const { return is_cut_off_; }
  uint64_t file_bytes() const { return file_bytes_; }

 private:
  struct Inflater;
  size_t read_file(std::byte* to, size_t count);
  uint64_t read_packed(std::byte* to, uint64_t count);
  std::string file_;
  int descriptor_ = -1;
  uint64_t position_ = 0, file_bytes_ = 0;
  bool is_cut_off_ = false;
  std::unique_ptr<Inflater> inflater_;
};

// Returns the first bytes of a file, unpacked if it is gzip; at most so many.
std::string first_bytes(const std::string& file, size_t most);

// Says whether a file begins as gzip does.
bool is_gzip(const std::string& file);

}  // namespace wellspring::volume
