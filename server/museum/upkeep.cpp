// SPDX-License-Identifier: Apache-2.0
#include "museum/upkeep.h"

#include <cmath>
#include <filesystem>

namespace wellspring::museum {

// Returns how many seconds the clock is off from a clock that has gone on since `seen`.
double Calendar::apart(const Seen& seen, std::time_t wall, double steady) {
  return std::abs(double(wall) - (seen.wall + steady - seen.steady));
}

std::time_t Calendar::see(std::time_t wall, double steady) {
  const bool is_set = wall >= first_time;
  if (!believed_ && !is_set) return wall;
  const bool goes_on = is_set && (!believed_ || apart(*believed_, wall, steady) <= leap);
  if (!goes_on && is_set) {
    if (!doubted_ || apart(*doubted_, wall, steady) > leap) doubted_ = {double(wall), steady};
  }
  if (goes_on || (is_set && steady - doubted_->steady >= patience)) {
    believed_ = {double(wall), steady};
    doubted_.reset();
    return wall;
  }
  if (!is_set) doubted_.reset();
  return std::time_t(believed_->wall + steady - believed_->steady);
}

std::vector<std::string> Disks::full() const {
  std::vector<std::string> found;
  for (const std::string& place : places_) {
    if (place.empty()) continue;
    std::error_code ec;
    std::filesystem::path at = std::filesystem::absolute(place, ec);
    while (!std::filesystem::exists(at, ec) && at.has_relative_path()) at = at.parent_path();
    const auto space = std::filesystem::space(at, ec);
    if (!ec && space.available < least_bytes) found.push_back(place);
  }
  return found;
}

}  // namespace wellspring::museum
