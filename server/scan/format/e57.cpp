// SPDX-License-Identifier: Apache-2.0
#include "scan/format/e57.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

#include "scan/format/column_source.h"
#include "scan/format/e57_section.h"

namespace wellspring::scan {
namespace {

constexpr double nan_place = std::numeric_limits<double>::quiet_NaN();

// Which stream of a scan is which; -1: it has none.
struct Streams {
  std::array<int, role_count> of;
  int range = -1, azimuth = -1, elevation = -1, invalid = -1;
  bool is_spherical = false;
};

Streams find_streams(const E57Scan& scan) {
  const auto find = [&](std::string_view name) {
    for (size_t i = 0; i < scan.streams.size(); i++)
      if (scan.streams[i].name == name && scan.streams[i].kind != E57Stream::Kind::text)
        return int(i);
    return -1;
  };
  Streams streams;
  streams.of.fill(-1);
  const std::pair<Role, const char*> names[] = {
      {Role::x, "cartesianX"},         {Role::y, "cartesianY"},
      {Role::z, "cartesianZ"},         {Role::red, "colorRed"},
      {Role::green, "colorGreen"},     {Role::blue, "colorBlue"},
      {Role::intensity, "intensity"},  {Role::normal_x, "nor:normalX"},
      {Role::normal_y, "nor:normalY"}, {Role::normal_z, "nor:normalZ"},
      {Role::time, "timeStamp"}};
  for (const auto& [role, name] : names) streams.of[size_t(role)] = find(name);
  streams.range = find("sphericalRange");
  streams.azimuth = find("sphericalAzimuth");
  streams.elevation = find("sphericalElevation");
  const auto has = [&](Role role) { return streams.of[size_t(role)] >= 0; };
  if (!has(Role::x) || !has(Role::y) || !has(Role::z)) {
    for (const Role role : {Role::x, Role::y, Role::z}) streams.of[size_t(role)] = -1;
    streams.is_spherical = streams.range >= 0 && streams.azimuth >= 0 && streams.elevation >= 0;
  }
  streams.invalid = find(streams.is_spherical ? "sphericalInvalidState" : "cartesianInvalidState");
  for (const Role first : {Role::red, Role::normal_x})
    if (!has(first) || !has(Role(int(first) + 1)) || !has(Role(int(first) + 2)))
      for (int i = 0; i < 3; i++) streams.of[size_t(first) + size_t(i)] = -1;
  return streams;
}

class E57Source : public ColumnSource {
 public:
  explicit E57Source(const std::string& path) : pages_(path), text_(read_e57_text(pages_)) {
    info_.file = path;
    info_.format = "E57";
    info_.is_counted = true;
    has_stations_ = text_.scans.size() > 1;
    for (const E57Scan& scan : text_.scans) {
      info_.points += scan.points;
      info_.stations.push_back({scan.name, scan.place});
      streams_.push_back(find_streams(scan));
      const Streams& streams = streams_.back();
      if (scan.points > 0 && streams.of[size_t(Role::x)] < 0 && !streams.is_spherical)
        pages_.file().fail(fmt::format("scan {}", streams_.size() - 1),
                           "has no coordinates of its points");
      for (size_t role = 0; role < role_count; role++)
        if (streams.of[role] >= 0) has_[role] = true;
      check_section(streams_.size() - 1);
    }
    if (text_.images > 0) note(fmt::format("{} pictures are not read", text_.images));
    if (info_.points == 0) note("holds no points");
    choose_ranges();
    begin();
  }

 private:
  // A section that would be read late is looked at now.
  void check_section(size_t index) {
    const E57Scan& scan = text_.scans[index];
    if (scan.section == 0 && scan.points == 0) return;  // old writers have no section then
    section_.emplace(pages_, scan, wanted(index));
    section_.reset();
  }

  std::vector<bool> wanted(size_t scan) const {
    const Streams& streams = streams_[scan];
    std::vector<bool> is_wanted(text_.scans[scan].streams.size());
    for (const int index : streams.of)
      if (index >= 0) is_wanted[size_t(index)] = true;
    if (streams.is_spherical)
      for (const int index : {streams.range, streams.azimuth, streams.elevation})
        is_wanted[size_t(index)] = true;
    if (streams.invalid >= 0) is_wanted[size_t(streams.invalid)] = true;
    return is_wanted;
  }

  // Colours become 0 to 255 if all scans have those, else 0 to 65535; intensities 0 to 65535.
  void choose_ranges() {
    bool is_byte = true, is_short = true;
    for (size_t i = 0; i < text_.scans.size(); i++) {
      E57Scan& scan = text_.scans[i];
      const auto complete = [&](E57Range& range, Role role) {
        const int index = streams_[i].of[size_t(role)];
        if (index < 0) return false;
        const E57Stream& stream = scan.streams[size_t(index)];
        if (!(range.high > range.low)) range = {stream.least, stream.most};
        if (range.high > range.low && range.high - range.low < 1e30) return true;
        range = {0, 1};
        note(fmt::format("{} of scan {} has no limits and is taken as 0 to 1", stream.name, i));
        return true;
      };
      if (complete(scan.color, Role::red)) {
        is_byte = is_byte && scan.color.low == 0 && scan.color.high == 255;
        is_short = is_short && scan.color.low == 0 && scan.color.high == 65535;
      }
      complete(scan.intensity, Role::intensity);
    }
    color_most_ = is_byte ? 255 : 65535;
    // Numbers of 16 bits may hold 8 alone.
    if (is_byte || !is_short) color_range_ = {0, color_most_};
    intensity_range_ = {0, 65535};
  }

  void read_columns(PointColumns& columns, size_t most) override {
    columns.count = 0;
    while (columns.count == 0) {
      if (!section_) {
        if (scan_ == text_.scans.size()) return;
        if (text_.scans[scan_].points == 0) {
          scan_++;
          continue;
        }
        section_.emplace(pages_, text_.scans[scan_], wanted(scan_));
      }
      columns.count = section_->read(most, values_);
      if (columns.count == 0) section_.reset(), scan_++;
      else fill(columns);
    }
  }

  void fill(PointColumns& columns) {
    const E57Scan& scan = text_.scans[scan_];
    const Streams& streams = streams_[scan_];
    columns.station = uint16_t(scan_);
    const auto rescale = [&](Role role, const E57Range& range, double most) {
      for (double& value : columns[role])
        value = (value - range.low) * most / (range.high - range.low);
    };
    for (size_t role = 0; role < role_count; role++) {
      const int index = streams.of[role];
      std::vector<double>& column = columns.column[role];
      if (index >= 0) column = values_[size_t(index)];
      else if (has_[role]) column.assign(columns.count, missing(Role(role)));
    }
    for (const Role role : {Role::red, Role::green, Role::blue})
      if (streams.of[size_t(role)] >= 0) rescale(role, scan.color, color_most_);
    if (streams.of[size_t(Role::intensity)] >= 0) rescale(Role::intensity, scan.intensity, 65535);
    fill_places(columns, scan, streams);
  }

  // A scan without colours among others with them is white; without normals, it has none.
  double missing(Role role) const {
    return role == Role::red || role == Role::green || role == Role::blue ? color_most_ : 0;
  }

  void fill_places(PointColumns& columns, const E57Scan& scan, const Streams& streams) {
    const glm::dmat3 turn = glm::mat3_cast(scan.turn);
    for (const Role role : {Role::x, Role::y, Role::z}) columns[role].resize(columns.count);
    for (size_t i = 0; i < columns.count; i++) {
      dvec3 place(columns[Role::x][i], columns[Role::y][i], columns[Role::z][i]);
      if (streams.is_spherical) {
        const double range = values_[size_t(streams.range)][i];
        const double azimuth = values_[size_t(streams.azimuth)][i];
        const double elevation = values_[size_t(streams.elevation)][i];
        place = range * dvec3(std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      }
      // A state of 1 is a direction without a place, 2 is neither.
      if (streams.invalid >= 0 && values_[size_t(streams.invalid)][i] != 0)
        place = dvec3(nan_place);
      else if (scan.is_posed) place = turn * place + scan.place;
      columns[Role::x][i] = place.x, columns[Role::y][i] = place.y, columns[Role::z][i] = place.z;
    }
    if (!has_[size_t(Role::normal_x)] || !scan.is_posed) return;
    for (size_t i = 0; i < columns.count; i++) {
      const dvec3 normal = turn * dvec3(columns[Role::normal_x][i], columns[Role::normal_y][i],
                                        columns[Role::normal_z][i]);
      columns[Role::normal_x][i] = normal.x, columns[Role::normal_y][i] = normal.y;
      columns[Role::normal_z][i] = normal.z;
    }
  }

  E57Pages pages_;
  E57Text text_;
  std::vector<Streams> streams_;        // each scan has its own
  std::array<bool, role_count> has_{};  // a scan has such a column
  double color_most_ = 255;
  std::optional<E57Section> section_;
  size_t scan_ = 0;  // the number of the scan that is read
  std::vector<std::vector<double>> values_;
};

}  // namespace

std::unique_ptr<PointSource> open_e57(const std::string& path) {
  return std::make_unique<E57Source>(path);
}

}  // namespace wellspring::scan
