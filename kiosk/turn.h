// SPDX-License-Identifier: Apache-2.0
// Which way a head is turned, as the lens sees it.
#pragma once
#include "base/vec.h"
#include "kiosk/face.h"

namespace wellspring {

struct Turn {
  mat3 seen{1};
};

// `face` is where the head is in `frame`; `detected` tells a fresh detection from one carried on. Returns the
// rotation with identity for a face that looks into the lens, in that visitor's axes (head.h, rotation_on_screen).
mat3 step_turn(Turn& turn, const GrayFrame& frame, const Face& face, bool detected);

}  // namespace wellspring
