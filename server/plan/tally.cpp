// SPDX-License-Identifier: Apache-2.0
#include "plan/tally.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wellspring::plan {
namespace {
constexpr double first = 1e-5, growth = 1.01;
}

void Tally::add(double seconds) {
  const double at = std::log(std::max(seconds, first) / first) / std::log(growth);
  classes_[size_t(std::min(at, double(classes_.size() - 1)))]++;
  count_++;
  sum_ += seconds;
  most_ = std::max(most_, seconds);
}

void Tally::add(const Tally& other) {
  for (size_t i = 0; i < classes_.size(); i++) classes_[i] += other.classes_[i];
  count_ += other.count_;
  sum_ += other.sum_;
  most_ = std::max(most_, other.most_);
}

double Tally::quantile(double p) const {
  if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = uint64_t(std::clamp(std::ceil(p * double(count_)), 1.0, double(count_)));
  uint64_t seen = 0;
  size_t i = 0;
  while ((seen += classes_[i]) < rank) i++;
  return std::min(first * std::pow(growth, double(i) + 0.5), most_);
}

double Tally::mean() const {
  return count_ > 0 ? sum_ / double(count_) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace wellspring::plan
