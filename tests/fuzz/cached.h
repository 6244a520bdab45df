// SPDX-License-Identifier: Apache-2.0
// Files that a server keeps (base/write_file.h) with foreign bytes in them: their format is that of
// a file which was saved, and their checksum is right, so that readers look at the rest.
#pragma once
#include <cstring>

#include "base/write_file.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

inline constexpr uint64_t cached_key = 1;

inline void replace_contents(const std::string& file, uint64_t format, Bytes bytes) {
  require(write_keyed(file, format, cached_key, text_of(bytes)), "files can be written");
}

inline uint64_t format_of(const std::string& saved) {
  uint64_t format = 0;
  std::ifstream in(saved, std::ios::binary);
  in.read(reinterpret_cast<char*>(&format), sizeof format);
  require(bool(in), "files can be read");
  return format;
}

}  // namespace wellspring::fuzz
