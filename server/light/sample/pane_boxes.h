// SPDX-License-Identifier: Apache-2.0
// Finds where light may pass straight through thin glass: shadow rays elsewhere only ask whether
// anything is in between.
#pragma once
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "light/material/albedo_table.h"
#include "light/material/material_use.h"
#include "light/transport_plan.h"
#include "world/world.h"

namespace wellspring::light {

// Holds what the shading loop asks about a material before it looks at any place of it.

struct MaterialTraits {
  const DielectricAlbedo* albedo = nullptr;  // null: nothing in use is made of it
  bool maybe_pane = false;                   // some place of it may be a thin smooth pane
  bool lambertian = false;                   // is_lambertian
  MetalDemodulation metal = MetalDemodulation::none;
};

// Holds boxes in groups of eight; the last group is filled up with its last box.
struct PaneBoxes {
  struct Group {
    Lanes low[3], high[3];
  };
  std::vector<Group> groups;
};

// Returns boxes around the instances whose material may be a pane, a few in one box if there are
// many; a single box without end if such instances move.
PaneBoxes make_pane_boxes(const World& world, const std::vector<MaterialTraits>& materials);

// Returns whether the ray meets one of the boxes before its t_max.
bool may_cross_pane(const PaneBoxes& boxes, const Ray& ray);

// Finds the bounds of a scene's solids (light/sample/medium.h).

// Holds boxes of the solids that stand still, for places that ask whether they are in one.
struct SolidBounds {
  Bounds all;
  std::vector<Bounds> each;
  uint64_t key = 0;  // unique
};
Bounds bounds_of(const PlacedMesh& placed);  // scene coordinates
SolidBounds find_solid_bounds(const World& world, const TransportPlan& plan);

}  // namespace wellspring::light
