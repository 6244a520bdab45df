// SPDX-License-Identifier: Apache-2.0
#include "scan/format/e57_pages.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>

namespace wellspring::scan {
namespace {

// Eight bytes a step: table k has the remainder of a byte with k zero bytes behind it.
constexpr auto crc_tables = [] {
  std::array<std::array<uint32_t, 256>, 8> tables{};
  for (uint32_t i = 0; i < 256; i++) {
    uint32_t rest = i;
    for (int bit = 0; bit < 8; bit++) rest = rest >> 1 ^ (rest & 1 ? 0x82f63b78u : 0);
    tables[0][i] = rest;
  }
  for (size_t k = 1; k < 8; k++)
    for (uint32_t i = 0; i < 256; i++)
      tables[k][i] = tables[k - 1][i] >> 8 ^ tables[0][tables[k - 1][i] & 255];
  return tables;
}();

}  // namespace

uint32_t crc_32c(const char* bytes, size_t count) {
  uint32_t crc = 0xffffffffu;
  for (; count >= 8; bytes += 8, count -= 8) {
    uint64_t eight;
    std::memcpy(&eight, bytes, 8);
    eight ^= crc;
    crc = 0;
    for (size_t k = 0; k < 8; k++) crc ^= crc_tables[7 - k][eight >> (8 * k) & 255];
  }
  for (; count > 0; bytes++, count--) crc = crc >> 8 ^ crc_tables[0][(crc ^ uint8_t(*bytes)) & 255];
  return ~crc;
}

E57Pages::E57Pages(const std::string& path) : file_(path) {
  if (file_.size() == 0 || file_.size() % page != 0)
    file_.fail(
        "", fmt::format("is cut off: its {} bytes are no whole pages of {}", file_.size(), page));
}

uint64_t E57Pages::to_logical(uint64_t physical) const {
  if (physical >= file_.size() || physical % page >= content)
    file_.fail("", fmt::format("names byte {}, where no data can be", physical));
  return physical / page * content + physical % page;
}

void E57Pages::read(uint64_t logical, char* to, uint64_t count) {
  if (logical > size() || count > size() - logical)
    file_.fail(fmt::format("byte {}", logical / content * page + logical % content),
               fmt::format("is cut off: {} bytes should follow", count));
  while (count > 0) {
    const uint64_t number = logical / content, within = logical % content;
    if (number != held_) {
      file_.go_to(number * page);
      held_ = UINT64_MAX;
      file_.take_to(bytes_, page);
      const auto* stored = reinterpret_cast<const uint8_t*>(bytes_ + content);
      const uint32_t wanted = uint32_t(stored[0]) << 24 | uint32_t(stored[1]) << 16 |
                              uint32_t(stored[2]) << 8 | stored[3];
      if (crc_32c(bytes_, content) != wanted)
        file_.fail(fmt::format("page {}, byte {}", number, number * page),
                   "is damaged: its checksum is wrong");
      held_ = number;
    }
    const uint64_t part = std::min(count, content - within);
    std::memcpy(to, bytes_ + within, part);
    to += part, logical += part, count -= part;
  }
}

}  // namespace wellspring::scan
