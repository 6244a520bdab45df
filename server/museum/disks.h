// SPDX-License-Identifier: Apache-2.0
// The disks that a museum writes to.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace wellspring::museum {

class Disks {
 public:
  static constexpr uint64_t least_bytes = 4 << 20;  // with fewer free ones it is full
  Disks() = default;
  // Both are what is written: files or folders, there or not yet; empty ones are left out.
  Disks(std::string cache, std::string sums) : places_{std::move(cache), std::move(sums)} {}
  std::vector<std::string> full() const;  // those of the places whose disks are

 private:
  std::vector<std::string> places_;
};

}  // namespace wellspring::museum
