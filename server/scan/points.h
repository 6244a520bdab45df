// SPDX-License-Identifier: Apache-2.0
// The points of a laser scanner or of photogrammetry as a file gives them, block by block.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::scan {

// Says which values the points have beside their places.
struct PointFields {
  bool color = false, intensity = false, classification = false, normal = false, time = false;
};

// Points in the file's order. A column whose field is absent is empty, the others are as long as
// `place`. The frame is the file's: unit and axes are not changed.
struct PointBlock {
  std::vector<dvec3> place;
  std::vector<std::array<uint16_t, 3>> color;  // sRGB, up to ScanInfo::color_max
  std::vector<uint16_t> intensity;             // 0 to 65535, up to ScanInfo::intensity_max
  std::vector<uint8_t> classification;         // codes of ASPRS
  std::vector<vec3> normal;                    // unit, or 0 if a point has none
  std::vector<double> time;                    // the file's unit
  // The number of the scan of several in one file, and so of its station; empty: all are of 0.
  std::vector<uint16_t> station;

  size_t size() const { return place.size(); }
  void clear();
};

// A scanner's pose: where it stood in the file's frame.
struct Station {
  std::string name;  // UTF-8; may be empty
  dvec3 place{0};
};

struct ScanInfo {
  std::string file, format;  // as the caller gave it; the format's name, for people
  uint64_t points = 0;       // as the file promises; a reader may find fewer, never more
  bool is_counted = false;   // `points` was read; false: unknown until the end (text)
  dvec3 low{0}, high{0};     // bounds as the file promises; is_bounded: it promises any
  bool is_bounded = false;
  double unit = 1;  // metres of the file's unit
  PointFields fields;
  uint16_t color_max = 255;        // 255 or 65535; 0: 65535, but 255 if no point has a larger value
  uint16_t intensity_max = 65535;  // the same
  std::vector<Station> stations;   // empty: unknown
  std::vector<std::string> notices;  // sentences about odd things that could be read all the same
};

// Reads a file from its first point to its last one. One thread at a time.
class PointSource {
 public:
  virtual ~PointSource() = default;
  const ScanInfo& info() const { return info_; }
  // Replaces `block` by the next points, at most so many; false: there are no more, and `block` is
  // empty. Points whose place is not finite are left out and counted in dropped(). Throws LoadError
  // if the file is damaged from here on.
  virtual bool read(PointBlock& block, size_t most) = 0;
  uint64_t dropped() const { return dropped_; }

 protected:
  ScanInfo info_;
  uint64_t dropped_ = 0;
};

}  // namespace wellspring::scan
