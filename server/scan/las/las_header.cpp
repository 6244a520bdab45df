// SPDX-License-Identifier: Apache-2.0
#include "scan/las/las_header.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/load_error.h"
#include "scan/las/las_bytes.h"

namespace wellspring::scan {
namespace {

constexpr size_t least_header = 227;  // bytes, of version 1.0
constexpr size_t header_of_14 = 375;  // has wide counts and records behind the points
constexpr size_t record_head = 54, late_record_head = 60;
constexpr size_t format_bytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

std::string las_text(std::span<const uint8_t> bytes) {
  return {bytes.begin(), std::find(bytes.begin(), bytes.end(), uint8_t(0))};
}

struct HeaderBytes {
  const std::string& file;
  std::span<const uint8_t> bytes;

  template <class Value>
  Value at(size_t place) const {
    return las_number<Value>(bytes.data() + place);
  }
  [[noreturn]] void fail(size_t place, const std::string& what) const {
    throw LoadError(file, fmt::format("byte {}", place), what);
  }
};

// Reads records from `begin` up to `end`, at most `count`. The late ones, which lie behind the
// points, may be longer than 64 kB.
void load_las_records(LasHeader& header, const HeaderBytes& from, uint64_t begin, uint64_t end,
                      uint64_t count, bool is_late) {
  const size_t head = is_late ? late_record_head : record_head;
  uint64_t read = 0;
  for (; read < count && begin <= end && end - begin >= head; read++) {
    const uint64_t size =
        is_late ? from.at<uint64_t>(begin + 20) : uint64_t(from.at<uint16_t>(begin + 20));
    if (size > end - begin - head) break;
    header.records.push_back({las_text(from.bytes.subspan(begin + 2, 16)),
                              from.at<uint16_t>(begin + 18),
                              from.bytes.subspan(begin + head, size)});
    begin += head + size;
  }
  if (read < count)
    header.notices.push_back(
        fmt::format("The header promises {} records {} the points, of which {} are there.", count,
                    is_late ? "behind" : "before", read));
}

uint64_t load_las_counts(const HeaderBytes& from, int minor, size_t header_size) {
  const uint64_t narrow = from.at<uint32_t>(107);
  if (minor < 4 || header_size < header_of_14) return narrow;
  const uint64_t wide = from.at<uint64_t>(247);
  return wide > 0 ? wide : narrow;
}

}  // namespace

const LasRecord* LasHeader::find(const std::string& user, uint16_t id) const {
  const auto found = std::ranges::find_if(
      records, [&](const LasRecord& record) { return record.user == user && record.id == id; });
  return found == records.end() ? nullptr : &*found;
}

bool is_las(std::span<const uint8_t> bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "LASF", 4) == 0;
}

LasHeader load_las_header(const std::string& file, std::span<const uint8_t> bytes) {
  const HeaderBytes from{file, bytes};
  if (!is_las(bytes)) from.fail(0, "is no LAS file: it does not begin with LASF");
  if (bytes.size() < least_header)
    from.fail(bytes.size(),
              fmt::format("ends within the header, which has {} bytes", least_header));
  LasHeader header;
  header.minor_version = bytes[25];
  if (bytes[24] != 1 || header.minor_version > 5)
    from.fail(24, fmt::format("is LAS {}.{}, which is not known", bytes[24], bytes[25]));
  const size_t size = from.at<uint16_t>(94);
  if (size < least_header || size > bytes.size())
    from.fail(94, fmt::format("says that the header has {} bytes", size));

  header.format = bytes[104] & 63;
  header.is_compressed = bytes[104] & 128;
  header.record_bytes = from.at<uint16_t>(105);
  if (header.format > 10) from.fail(104, fmt::format("has points of format {}", header.format));
  if (header.record_bytes < format_bytes[header.format])
    from.fail(
        105, fmt::format("gives points of format {} {} bytes", header.format, header.record_bytes));
  header.points_begin = from.at<uint32_t>(96);
  header.points = load_las_counts(from, header.minor_version, size);
  if (header.points_begin < size || (header.points_begin > bytes.size() && header.points > 0))
    from.fail(96, fmt::format("says that points begin at byte {}", header.points_begin));
  for (int i = 0; i < 3; i++) {
    header.scale[i] = from.at<double>(131 + 8 * size_t(i));
    header.offset[i] = from.at<double>(155 + 8 * size_t(i));
    header.high[i] = from.at<double>(179 + 16 * size_t(i));
    header.low[i] = from.at<double>(187 + 16 * size_t(i));
    if (!std::isfinite(header.scale[i]) || header.scale[i] == 0)
      from.fail(131, fmt::format("has the scale {} along {}", header.scale[i], "xyz"[i]));
    if (!std::isfinite(header.offset[i]))
      from.fail(155, fmt::format("has the offset {} along {}", header.offset[i], "xyz"[i]));
  }

  const uint64_t records_end = std::min<uint64_t>(header.points_begin, bytes.size());
  load_las_records(header, from, size, records_end, from.at<uint32_t>(100), false);
  if (header.minor_version < 4 || size < header_of_14) return header;
  const uint64_t late = from.at<uint64_t>(235), late_count = from.at<uint32_t>(243);
  if (late_count > 0) load_las_records(header, from, late, bytes.size(), late_count, true);
  return header;
}

}  // namespace wellspring::scan
