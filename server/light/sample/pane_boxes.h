// SPDX-License-Identifier: Apache-2.0
// Where light may pass straight through thin glass: shadow rays elsewhere only ask whether anything
// is in between.
#pragma once
#include <vector>

#include "base/simd.h"
#include "light/sample/material_traits.h"
#include "world/world.h"

namespace wellspring::light {

// Eight a group, the last filled up with its last one.
struct PaneBoxes {
  struct Group {
    Lanes low[3], high[3];
  };
  std::vector<Group> groups;
};

// Boxes around the instances whose material may be a pane, a few in one where there are many; one
// without end where such things move.
PaneBoxes make_pane_boxes(const World& world, const std::vector<MaterialTraits>& materials);

// Does the ray meet one of the boxes before its t_max?
bool may_cross_pane(const PaneBoxes& boxes, const Ray& ray);

}  // namespace wellspring::light
