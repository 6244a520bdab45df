// SPDX-License-Identifier: Apache-2.0
#include "scan/format/column_source.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

namespace wellspring::scan {
namespace {

struct NamedRole {
  const char* name;
  Role role;
};
constexpr NamedRole named_roles[] = {
    {"x", Role::x},
    {"y", Role::y},
    {"z", Role::z},
    {"red", Role::red},
    {"green", Role::green},
    {"blue", Role::blue},
    {"r", Role::red},
    {"g", Role::green},
    {"b", Role::blue},
    {"diffuse_red", Role::red},
    {"diffuse_green", Role::green},
    {"diffuse_blue", Role::blue},
    {"intensity", Role::intensity},
    {"scalar_intensity", Role::intensity},
    {"i", Role::intensity},
    {"reflectance", Role::intensity},
    {"scalar_reflectance", Role::intensity},
    {"nx", Role::normal_x},
    {"ny", Role::normal_y},
    {"nz", Role::normal_z},
    {"normal_x", Role::normal_x},
    {"normal_y", Role::normal_y},
    {"normal_z", Role::normal_z},
    {"classification", Role::classification},
    {"scalar_classification", Role::classification},
    {"gps_time", Role::time},
    {"gpstime", Role::time},
    {"scalar_gpstime", Role::time},
};

// Extremes of finite numbers, and whether any has a fraction.
struct Extremes {
  double low = INFINITY, high = -INFINITY;
  bool is_whole = true;
};

void look_at(const std::vector<double>& values, Extremes& extremes) {
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    extremes.low = std::min(extremes.low, value);
    extremes.high = std::max(extremes.high, value);
    if (value != std::floor(value)) extremes.is_whole = false;
  }
}

}  // namespace

Role role_named(std::string_view name) {
  std::string small;
  for (const char letter : name)
    small += letter >= 'A' && letter <= 'Z' ? char(letter - 'A' + 'a') : letter;
  for (const NamedRole& known : named_roles)
    if (small == known.name) return known.role;
  return Role::none;
}

void ColumnSource::begin() {
  read_columns(piece_, piece_size);
  info_.fields.color = !piece_[Role::red].empty();
  info_.fields.intensity = !piece_[Role::intensity].empty();
  info_.fields.normal = !piece_[Role::normal_x].empty();
  info_.fields.classification = !piece_[Role::classification].empty();
  info_.fields.time = !piece_[Role::time].empty();
  judge_colors();
  judge_intensities();
}

// Numbers of 8 and of 16 bits stay as they are; the brightest of others becomes 65535.
void ColumnSource::judge_colors() {
  if (!info_.fields.color) return;
  Extremes seen;
  if (!color_range_.is_known()) {
    for (const Role role : {Role::red, Role::green, Role::blue}) look_at(piece_[role], seen);
    const bool is_unit = (colors_are_real_ || !seen.is_whole) && seen.high <= 1;
    if (is_unit) color_range_ = {0, 1};
  }
  if (!color_range_.is_known()) {
    info_.color_max = 0;
    return;
  }
  info_.color_max = color_range_.low == 0 && color_range_.high == 255 ? 255 : 65535;
  color_ = {color_range_.low, info_.color_max / (color_range_.high - color_range_.low),
            info_.color_max};
}

void ColumnSource::judge_intensities() {
  if (!info_.fields.intensity) return;
  Range& range = intensity_range_;
  if (!range.is_known()) {
    Extremes seen;
    look_at(piece_[Role::intensity], seen);
    const bool is_signed = seen.low < 0 || (is_leica_ && seen.high > 255);
    if (is_signed && seen.low >= -2048 && seen.high <= 2047) range = {-2048, 2047};
    else if (seen.low >= 0 && seen.high <= 1 && !seen.is_whole) range = {0, 1};
    else if (seen.low < 0 || seen.high > 65535) {
      range = {seen.low, std::max(seen.high, seen.low + 1)};
      note(fmt::format("intensities are taken as {} to {}, as those of the first points", range.low,
                       range.high));
    }
  }
  if (!range.is_known()) {
    info_.intensity_max = 0;
    return;
  }
  info_.intensity_max = range.low == 0 && range.high == 255 ? 255 : 65535;
  intensity_ = {range.low, info_.intensity_max / (range.high - range.low), info_.intensity_max};
}

bool ColumnSource::read(PointBlock& block, size_t most) {
  block.clear();
  while (block.size() < most && !is_done_) {
    if (next_ == piece_.count) {
      read_columns(piece_, piece_size);
      next_ = 0;
      is_done_ = piece_.count == 0;
    }
    const size_t count = std::min(most - block.size(), piece_.count - next_);
    append(block, next_, count);
    next_ += count;
  }
  if (is_done_ && cut_ > 0) {
    note(fmt::format("{} colours or intensities beyond the range of the others were cut", cut_));
    cut_ = 0;
  }
  return block.size() > 0;
}

void ColumnSource::append(PointBlock& block, size_t from, size_t count) {
  const auto scaled = [this](double value, const Scale& scale) {
    const double wanted = std::floor((value - scale.low) * scale.factor + 0.5);
    if (wanted >= 0 && wanted <= scale.most) return uint16_t(wanted);
    cut_++;
    return wanted > scale.most ? scale.most : uint16_t(0);  // a NaN becomes 0, too
  };
  for (size_t i = from; i < from + count; i++) {
    const dvec3 place(piece_[Role::x][i], piece_[Role::y][i], piece_[Role::z][i]);
    if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z)) {
      dropped_++;
      continue;
    }
    block.place.push_back(place);
    if (info_.fields.color)
      block.color.push_back({scaled(piece_[Role::red][i], color_),
                             scaled(piece_[Role::green][i], color_),
                             scaled(piece_[Role::blue][i], color_)});
    if (info_.fields.intensity)
      block.intensity.push_back(scaled(piece_[Role::intensity][i], intensity_));
    if (info_.fields.classification) {
      const double code = piece_[Role::classification][i];
      block.classification.push_back(code >= 0 && code <= 255 ? uint8_t(code) : uint8_t(0));
    }
    if (info_.fields.normal) {
      const vec3 normal(piece_[Role::normal_x][i], piece_[Role::normal_y][i],
                        piece_[Role::normal_z][i]);
      const float length = glm::length(normal);
      const bool has_one = std::isfinite(length) && length > 1e-6f;
      block.normal.push_back(has_one ? normal / length : vec3(0));
    }
    if (info_.fields.time) block.time.push_back(piece_[Role::time][i]);
    if (has_stations_) block.station.push_back(piece_.station);
  }
}

}  // namespace wellspring::scan
