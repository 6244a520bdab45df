// SPDX-License-Identifier: Apache-2.0
// Where light may pass straight through thin glass: shadow rays elsewhere only ask whether anything
// is in between.
#pragma once
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "light/material/albedo_table.h"
#include "light/material/material_use.h"
#include "light/transport_plan.h"
#include "world/world.h"

namespace wellspring::light {

// What the shading loop wants to know of a material before it looks at any place of it.

struct MaterialTraits {
  const DielectricAlbedo* albedo = nullptr;  // null: nothing in use is made of it
  bool maybe_pane = false;                   // some place of it may be a thin smooth pane
  bool lambertian = false;                   // is_lambertian
  MetalDemodulation metal = MetalDemodulation::none;
};

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

// Where the solids of a scene are (light/sample/medium.h).

// Boxes of the solids that stand still, for places that ask whether they are in one.
struct SolidBounds {
  Bounds all;
  std::vector<Bounds> each;
  uint64_t key = 0;  // no other has it
};
Bounds bounds_of(const PlacedMesh& placed);  // scene coordinates
SolidBounds find_solid_bounds(const World& world, const TransportPlan& plan);

}  // namespace wellspring::light
