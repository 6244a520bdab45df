// SPDX-License-Identifier: Apache-2.0
#include "kiosk/turn.h"

#include <cmath>

#include "kiosk/head.h"

namespace wellspring {

mat3 step_turn(Turn& turn, const GrayFrame&, const Face& face, bool detected) {
  if (!detected) return turn.seen;
  if (face.eyes) {
    vec2 d = (*face.eyes)[1] - (*face.eyes)[0];
    turn.seen = rotation_matrix({0, 0, std::atan2(-d.y, d.x)});
  }
  return turn.seen;
}

}  // namespace wellspring
