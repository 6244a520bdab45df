// SPDX-License-Identifier: Apache-2.0
// Where light may pass straight through thin glass: shadow rays elsewhere only ask whether anything is in
// between.
#pragma once
#include "light/light_tables.h"
#include "world/bvh.h"

namespace wellspring {

// Boxes around the instances whose material may be a pane, a few in one where there are many; one
// without end where such things move.
std::vector<Bounds> make_pane_boxes(const World& world, const std::vector<MaterialTraits>& materials);

// Does the ray meet one of the boxes before its t_max?
bool may_cross_pane(const LightTables& tables, const Ray& ray);

}  // namespace wellspring
