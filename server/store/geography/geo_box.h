// SPDX-License-Identifier: Apache-2.0
// Holds boxes of places, and finds those that touch another one.
#pragma once
#include <algorithm>
#include <vector>

#include "base/layers.h"
#include "base/vec.h"

namespace wellspring::store {

// Holds an axis-aligned box; an empty one has its low corner above the high one.
struct GeoBox {
  dvec2 low{1e300}, high{-1e300};
  bool empty() const { return !(low.x <= high.x && low.y <= high.y); }
  void add(dvec2 point) { low = glm::min(low, point), high = glm::max(high, point); }
  void add(const GeoBox& box) {
    if (!box.empty()) low = glm::min(low, box.low), high = glm::max(high, box.high);
  }
  bool touches(const GeoBox& box) const {
    return low.x <= box.high.x && box.low.x <= high.x && low.y <= box.high.y && box.low.y <= high.y;
  }
  GeoBox grown(double by) const { return {low - by, high + by}; }
};

// Finds boxes of a list in its order: each group of 16 neighbours has a box, and so on.
class GeoBoxTree {
 public:
  GeoBoxTree() = default;
  explicit GeoBoxTree(std::vector<GeoBox> boxes);
  // Calls each(index) for the boxes that touch `box`, in their order.
  template <class Each>
  void visit(const GeoBox& box, const Each& each) const {
    if (!levels_.empty()) visit(box, levels_.size() - 1, 0, levels_.back().size(), each);
  }

 private:
  static constexpr size_t group_ = 16;
  template <class Each>
  void visit(const GeoBox& box, size_t level, size_t first, size_t end, const Each& each) const {
    const std::vector<GeoBox>& boxes = levels_[level];
    for (size_t i = first; i < end; i++) {
      if (!boxes[i].touches(box)) continue;
      if (level == 0) each(i);
      else
        visit(box, level - 1, i * group_, std::min((i + 1) * group_, levels_[level - 1].size()),
              each);
    }
  }
  std::vector<std::vector<GeoBox>> levels_;  // the first has each box; empty: there is none
};

}  // namespace wellspring::store
