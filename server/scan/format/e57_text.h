// SPDX-License-Identifier: Apache-2.0
// The XML of E57 files (ASTM E2807-11, section 8): which scans there are, and how the numbers of
// their points are stored.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scan/format/e57_pages.h"

namespace wellspring::scan {

// A number that every point of a scan has, as it is stored.
struct E57Stream {
  enum class Kind : uint8_t { integer, single_real, double_real, text };
  std::string name;  // "cartesianX"
  Kind kind = Kind::double_real;
  int bits = 64;    // each number has so many; 0: all are `low`
  int64_t low = 0;  // a stored 0 means this
  double scale = 1, offset = 0;
  double least = 0, most = 0;  // as the file promises, scaled; equal: unknown
};

struct E57Range {
  double low = 0, high = 0;  // equal: unknown
};

struct E57Scan {
  std::string name;
  glm::dquat turn{1, 0, 0, 0};  // from the scan's frame into the file's
  dvec3 place{0};
  bool is_posed = false;
  uint64_t section = 0;  // physical place of the points
  uint64_t points = 0;
  std::vector<E57Stream> streams;  // in the order of their bytes
  E57Range color, intensity;       // the limits that the scan states
};

struct E57Text {
  std::vector<E57Scan> scans;
  size_t images = 0;  // which are not read
};

// Reads header and XML. Throws LoadError.
E57Text read_e57_text(E57Pages& pages);

}  // namespace wellspring::scan
