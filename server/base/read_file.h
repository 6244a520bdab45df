// SPDX-License-Identifier: Apache-2.0
// Reads whole files that others wrote, up to a bound.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace wellspring {

// Files of packages must be regular: a pipe would let the reader wait. People may name a pipe, too.
enum class FileKind : uint8_t { regular, regular_or_pipe };

// Calls `resize` for the place of so many bytes, which keeps those that are there, as the file
// needs it; in the end with the number of bytes read.
void read_file_into(const std::string& path, size_t most_bytes, FileKind kind,
                    const std::function<void*(size_t)>& resize);

// Returns the whole file as a container of bytes. Throws LoadError if it cannot be read, is not of
// this kind, or is larger than `most_bytes`.
template <class Bytes = std::string>
Bytes read_file(const std::string& path, size_t most_bytes, FileKind kind = FileKind::regular) {
  static_assert(sizeof(typename Bytes::value_type) == 1);
  Bytes bytes;
  read_file_into(path, most_bytes, kind, [&](size_t size) {
    bytes.resize(size);
    return bytes.data();
  });
  return bytes;
}

}  // namespace wellspring
