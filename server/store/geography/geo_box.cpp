// SPDX-License-Identifier: Apache-2.0
#include "store/geography/geo_box.h"

namespace wellspring::store {

GeoBoxTree::GeoBoxTree(std::vector<GeoBox> boxes) {
  if (boxes.empty()) return;
  levels_.push_back(std::move(boxes));
  while (levels_.back().size() > group_) {
    const std::vector<GeoBox>& below = levels_.back();
    std::vector<GeoBox> above((below.size() + group_ - 1) / group_);
    for (size_t i = 0; i < below.size(); i++) above[i / group_].add(below[i]);
    levels_.push_back(std::move(above));
  }
}

}  // namespace wellspring::store
