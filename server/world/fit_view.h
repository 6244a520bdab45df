// SPDX-License-Identifier: Apache-2.0
// How far from a box an eye sees all of it.
#pragma once
#include "base/vec.h"

namespace wellspring::world {

// From the box's middle along the unit direction `back`, for a picture whose half sides at a depth
// of 1 are `tan_x` and `tan_y`; `half` are half the box's sides. At least a millimetre.
float distance_to_fit(vec3 half, vec3 back, float tan_x, float tan_y);

}  // namespace wellspring::world
