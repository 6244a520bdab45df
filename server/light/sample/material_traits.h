// SPDX-License-Identifier: Apache-2.0
// What the shading loop wants to know of a material before it looks at any place of it.
#pragma once
#include "light/material/albedo_table.h"
#include "light/material/material_use.h"

namespace wellspring::light {

struct MaterialTraits {
  const DielectricAlbedo* albedo = nullptr;  // null: nothing in use is made of it
  bool maybe_pane = false;                   // some place of it may be a thin smooth pane
  bool lambertian = false;                   // is_lambertian
  MetalDemodulation metal = MetalDemodulation::none;
};

}  // namespace wellspring::light
