// SPDX-License-Identifier: Apache-2.0
// Counts durations by classes that are 1 % wide, so that quantiles of millions take little memory.
#pragma once
#include <array>
#include <cstdint>

#include "base/layers.h"

namespace wellspring::plan {

class Tally {
 public:
  void add(double seconds);
  void add(const Tally& other);
  uint64_t count() const { return count_; }
  // Returns the p-quantile (0..1) in seconds, by the nearest rank and within 1 %; NaN of none.
  double quantile(double p) const;
  double mean() const;                      // seconds; NaN of none
  double longest() const { return most_; }  // seconds; 0 of none

 private:
  std::array<uint32_t, 1900> classes_{};  // from 10 microseconds to 26 minutes
  uint64_t count_ = 0;
  double sum_ = 0, most_ = 0;
};

}  // namespace wellspring::plan
