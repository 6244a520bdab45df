// SPDX-License-Identifier: Apache-2.0
// An object of a collection as a set: weighted points in R^p, of which each has a place for every
// property. Sets are compared by the Earth Mover's Distance whose ground distance is Mahalanobis'
// (P06, sections 2.2 and 3.1): so neither ranges nor correlations of properties matter.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/layers.h"

namespace wellspring::collection {

inline constexpr int most_points = 12;      // a set keeps; more are merged, the nearest first
inline constexpr int most_properties = 16;  // the p of R^p

// Holds points one after the other, each with `properties` numbers, and what each weighs.
struct SetItem {
  std::vector<double> points;
  std::vector<double> masses;  // above 0; any sum
};

// Refers to a set whose points lie where Mahalanobis' distance is Euclid's: `dims` rows of `stride`
// floats, of which the first `count` are points. Masses are whole multiples of 2^-50 and sum to
// exactly 1, so that what is moved never has rounding.
struct SetView {
  const float* rows = nullptr;
  const double* masses = nullptr;
  const double* mean = nullptr;  // weighted, `dims` numbers
  int count = 0, stride = 0;
};

// Keeps all sets of a collection, in the coordinates of SetView. Immutable once made.
class Sets {
 public:
  Sets() = default;
  // `properties`: numbers of a point, at most most_properties. Numbers must be finite, and each set
  // must have a point.
  Sets(std::span<const SetItem> items, int properties);

  int size() const { return int(begin_.size()); }
  int dims() const { return dims_; }  // at most `properties`; fewer where some are never different
  SetView operator[](int i) const;

 private:
  struct Begin {
    uint32_t rows, masses;
    uint16_t count, stride;
  };
  int dims_ = 0;
  std::vector<Begin> begin_;
  std::vector<float> rows_;
  std::vector<double> masses_, means_;
};

// Returns rows w so that |W (f - g)| is Mahalanobis' distance of f and g by the covariance over all
// points. Directions in which no two points differ have no row. `points`: one after the other.
std::vector<double> whitening_rows(std::span<const double> points, int properties);

// Merges the nearest points, weighted, until at most `most` are left.
void merge_nearest(SetItem& item, int properties, int most);

}  // namespace wellspring::collection
