// SPDX-License-Identifier: Apache-2.0
#include "scan/format/lzf.h"

#include <algorithm>
#include <cstdint>

namespace wellspring::scan {

// A byte below 32 says how many bytes follow as they are, less one. Any other begins a copy of what
// was unpacked before: 3 bits of length, 7 continued by a byte; 13 bits of distance, less one.
bool unpack_lzf(std::string_view packed, size_t size, std::string& bytes) {
  bytes.clear();
  size_t at = 0;
  const auto next = [&] { return size_t(uint8_t(packed[at++])); };
  while (at < packed.size()) {
    const size_t control = next();
    if (control < 32) {
      const size_t count = control + 1;
      if (count > packed.size() - at || count > size - bytes.size()) return false;
      bytes.append(packed, at, count);
      at += count;
      continue;
    }
    size_t length = control >> 5;
    if (length == 7) {
      if (at == packed.size()) return false;
      length += next();
    }
    length += 2;
    if (at == packed.size()) return false;
    const size_t distance = ((control & 31) << 8 | next()) + 1;
    if (distance > bytes.size() || length > size - bytes.size()) return false;
    // The copy may reach into itself.
    for (size_t from = bytes.size() - distance; length > 0; length--) bytes += bytes[from++];
  }
  return bytes.size() == size;
}

}  // namespace wellspring::scan
