// SPDX-License-Identifier: Apache-2.0
#include "museum/disks.h"

#include <filesystem>

namespace wellspring::museum {

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
