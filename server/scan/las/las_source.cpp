// SPDX-License-Identifier: Apache-2.0
#include "scan/las/las_source.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "scan/las/las_bytes.h"
#include "scan/las/las_records.h"

namespace wellspring::scan {
namespace {

// Columns of a record, as bytes from its beginning; -1: it has none.
struct RecordColumns {
  int classification = 15, time = -1, color = -1;
  uint8_t class_bits = 31;
};

RecordColumns columns_of(int format) {
  RecordColumns columns;
  if (format >= 6) {
    columns = {16, 22, format == 6 || format == 9 ? -1 : 30, 255};
    return columns;
  }
  const bool has_color = format == 2 || format == 3 || format == 5;
  if (format == 1 || format >= 3) columns.time = 20;
  if (has_color) columns.color = format == 2 ? 20 : 28;
  return columns;
}

constexpr int at_intensity_of_record = 12;

class LasSource : public PointSource {
 public:
  explicit LasSource(const std::string& path)
      : file_(path), columns_(columns_of(file_.header().format)) {
    const LasHeader& header = file_.header();
    info_.file = path;
    const bool is_copc = header.is_compressed && header.find("copc", 1);
    info_.format = fmt::format("{} 1.{}, point format {}",
                               is_copc                ? "COPC"
                               : header.is_compressed ? "LAZ"
                                                      : "LAS",
                               header.minor_version, header.format);
    info_.points = header.points;
    info_.is_counted = true;
    info_.low = header.low, info_.high = header.high;
    info_.is_bounded = true;
    for (int i = 0; i < 3; i++)
      if (!(header.low[i] <= header.high[i]) || std::isinf(header.low[i]) ||
          std::isinf(header.high[i]))
        info_.is_bounded = false;
    info_.notices = header.notices;
    info_.unit = las_unit(header, info_.notices);
    info_.fields.color = columns_.color >= 0;
    info_.fields.time = columns_.time >= 0;
    info_.fields.intensity = info_.fields.classification = true;
    info_.color_max = info_.intensity_max = 0;
  }

  bool read(PointBlock& block, size_t most) override {
    block.clear();
    const size_t stride = file_.header().record_bytes;
    while (block.size() < most) {
      const std::span<const uint8_t> records = file_.records().read(most - block.size());
      if (records.empty()) break;
      for (size_t at = 0; at < records.size(); at += stride) add(block, records.data() + at);
    }
    return block.size() > 0;
  }

 private:
  void add(PointBlock& block, const uint8_t* record) {
    const LasHeader& header = file_.header();
    dvec3 place;
    for (int i = 0; i < 3; i++)
      place[i] = las_number<int32_t>(record + 4 * i) * header.scale[i] + header.offset[i];
    if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z)) {
      dropped_++;
      return;
    }
    block.place.push_back(place);
    block.intensity.push_back(las_number<uint16_t>(record + at_intensity_of_record));
    block.classification.push_back(record[columns_.classification] & columns_.class_bits);
    if (columns_.color >= 0)
      block.color.push_back(las_number<std::array<uint16_t, 3>>(record + columns_.color));
    if (columns_.time >= 0) block.time.push_back(read_time(record + columns_.time));
  }

  double read_time(const uint8_t* from) {
    const double time = las_number<double>(from);
    if (std::isfinite(time)) return time;
    if (!has_bad_time_) info_.notices.push_back("Times that are no numbers are taken as 0.");
    has_bad_time_ = true;
    return 0;
  }

  LasFile file_;
  RecordColumns columns_;
  bool has_bad_time_ = false;
};

}  // namespace

std::unique_ptr<PointSource> open_las(const std::string& path) {
  return std::make_unique<LasSource>(path);
}

}  // namespace wellspring::scan
