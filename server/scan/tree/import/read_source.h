// SPDX-License-Identifier: Apache-2.0
// The first stage of an import: all points of a source become records in a file, in the tree's
// frame, and what must be known of them as a whole is found.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "base/write_file.h"
#include "scan/points.h"
#include "scan/tree/data_file.h"
#include "scan/tree/import/work.h"
#include "scan/tree/tree_settings.h"

namespace wellspring::scan {

inline constexpr double farthest_place = 1e8;  // metres along an axis, from the frame's origin

// A point as it was read.
struct ReadPoint {
  dvec3 place;  // metres, +Y up
  std::array<uint16_t, 3> color;
  uint16_t intensity;
  uint16_t normal;   // octahedral, in the tree's frame
  uint16_t station;  // one of its source's
  uint8_t classification;
  std::array<uint8_t, 3> none;
};
static_assert(sizeof(ReadPoint) == 40);

struct SourceFacts {
  uint64_t points = 0, dropped = 0;
  dvec3 low{0}, high{0};  // bounds the points that are there, whatever the file promised
  uint16_t color_max = 0, intensity_max = 0;  // as ScanInfo says
  uint16_t top_color = 0, top_intensity = 0;  // the largest that are there
  uint32_t fields = 0;                        // TreeFieldBits
  std::vector<Station> stations;              // in the tree's frame
  std::vector<std::string> notices;

  template <class Bytes>
  void list(Bytes& bytes) {
    bytes.value(points), bytes.value(dropped), bytes.value(low), bytes.value(high);
    bytes.value(color_max), bytes.value(intensity_max);
    bytes.value(top_color), bytes.value(top_intensity), bytes.value(fields);
  }
};

// A source counts so many items of progress.
inline constexpr uint64_t read_share = 1000000;

// Returns the rotation from the sources' axes to the tree's.
glm::dmat3 frame_of(const TreeSettings& settings);

// Throws LoadError.
SourceFacts read_source(const TreeSource& source, const TreeSettings& settings, const DataFile& to,
                        HeldBytes& held, StageProgress& progress);

}  // namespace wellspring::scan
