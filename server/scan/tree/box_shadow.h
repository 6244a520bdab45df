// SPDX-License-Identifier: Apache-2.0
// Finds what a box hides from an eye (paper on large particle sets, section 4.3.1). The paper
// projects the box to the picture, takes the convex silhouette of its corners, and compares depths
// with planes through them. Here is the same in space, so that it needs no picture and holds for
// what lies behind the eye, too: each edge of the silhouette spans a plane with the eye, and the
// faces that look at the eye are the depth planes. A convex thing within all planes is hidden.
#pragma once
#include <array>

#include "base/vec.h"

namespace wellspring::scan {

struct DoubleBox {
  dvec3 low{0}, high{0};
};

class BoxShadow {
 public:
  // The eye must lie outside the box: else there is no shadow, and nothing is hidden.
  BoxShadow(const dvec3& eye, const DoubleBox& box);
  // Returns whether all sight lines from the eye to the other box go through this one. True also of
  // the box's own insides: the caller takes boxes that are disjoint.
  bool hides(const DoubleBox& other) const;

 private:
  struct Plane {
    dvec3 normal;   // inward
    double offset;  // dot(normal, place) + offset >= 0 inside
  };
  void add(const dvec3& normal, const dvec3& through);
  std::array<Plane, 9> planes_;  // at most 6 of the silhouette, 3 faces
  int count_ = 0;
};

}  // namespace wellspring::scan
