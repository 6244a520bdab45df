// SPDX-License-Identifier: Apache-2.0
// The common part of readers of points: columns of plain numbers become blocks of points.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "scan/points.h"

namespace wellspring::scan {

enum class Role : uint8_t {
  x,
  y,
  z,
  red,
  green,
  blue,
  intensity,
  normal_x,
  normal_y,
  normal_z,
  classification,
  time,
  none
};
inline constexpr size_t role_count = size_t(Role::none);

// Returns what a column of such a name holds, as programs that write PLY, PCD and text name them.
Role role_named(std::string_view name);

// The numbers of some points as they stand in a file. A column that the file does not have is
// empty, the others are `count` long.
struct PointColumns {
  size_t count = 0;
  std::array<std::vector<double>, role_count> column;
  uint16_t station = 0;  // all of them are of this scan

  std::vector<double>& operator[](Role role) { return column[size_t(role)]; }
  const std::vector<double>& operator[](Role role) const { return column[size_t(role)]; }
};

// Makes points of the columns that a reader gives. A reader says what it knows of the ranges of
// colours and intensities; ranges that are unknown are judged by the file's first points.
class ColumnSource : public PointSource {
 public:
  bool read(PointBlock& block, size_t most) override;

 protected:
  static constexpr size_t piece_size = 4096;
  struct Range {
    double low = 0, high = 0;  // equal: unknown
    bool is_known() const { return high > low; }
  };
  Range color_range_, intensity_range_;
  bool colors_are_real_ = false;  // they are floating point: 1 may be the brightest
  bool is_leica_ = false;         // intensities beyond 255 are of -2048 to 2047
  bool has_stations_ = false;

  // Replaces the columns by the next points, at most so many; a count of 0: there are no more. The
  // number may be smaller though more follow.
  virtual void read_columns(PointColumns& columns, size_t most) = 0;
  // Looks at the first points. The last step of a constructor.
  void begin();
  // Adds a sentence about the file.
  void note(std::string sentence) { info_.notices.push_back(std::move(sentence)); }

 private:
  struct Scale {
    double low = 0, factor = 1;
    uint16_t most = 65535;
  };
  void judge_colors();
  void judge_intensities();
  void append(PointBlock& block, size_t from, size_t count);
  Scale color_, intensity_;
  PointColumns piece_;
  size_t next_ = 0;  // index of the next point in the piece
  uint64_t cut_ = 0;
  bool is_done_ = false;
};

}  // namespace wellspring::scan
