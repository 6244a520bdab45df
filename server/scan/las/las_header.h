// SPDX-License-Identifier: Apache-2.0
// Reads the header of a LAS file, versions 1.0 to 1.5, and the records of variable length behind it
// (ASPRS, "LAS Specification 1.4 - R15", sections 2.3 to 2.7).
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace wellspring::scan {

// A record of variable length: who defined it, its number, and its bytes in the file.
struct LasRecord {
  std::string user;
  uint16_t id = 0;
  std::span<const uint8_t> bytes;
};

struct LasHeader {
  int minor_version = 0;  // 2 is LAS 1.2
  int format = 0;         // the points' format, 0 to 10
  bool is_compressed = false;
  size_t record_bytes = 0;    // a point has so many
  uint64_t points_begin = 0;  // a byte of the file
  uint64_t points = 0;        // as the header promises
  dvec3 scale{1}, offset{0};
  dvec3 low{0}, high{0};           // bounds, as they stand there
  std::vector<LasRecord> records;  // those that lie within the file
  std::vector<std::string> notices;

  // Returns the record, or nullptr.
  const LasRecord* find(const std::string& user, uint16_t id) const;
};

// Says whether a file begins as LAS files do.
bool is_las(std::span<const uint8_t> bytes);

// Borrows the bytes of the file. Throws LoadError if points cannot be read by it; records that are
// damaged get a notice.
LasHeader load_las_header(const std::string& file, std::span<const uint8_t> bytes);

// Returns how many metres the unit of places is: of metre, foot and US survey foot. For others, and
// for degrees, it is 1, and a notice says so.
double las_unit(const LasHeader& header, std::vector<std::string>& notices);
// The same of a text that describes the space of places (WKT).
double wkt_unit(std::string_view wkt, std::vector<std::string>& notices);

}  // namespace wellspring::scan
