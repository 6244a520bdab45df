// SPDX-License-Identifier: Apache-2.0
#include "lawn/response.h"

namespace wellspring::lawn {
namespace {

// Moves the ends of a spring together or apart; `first_moves` is the share of the first, 0 or 0.5.
void relax(Lanes3& first, Lanes3& second, const Lanes& rest, const Lanes& stiffness,
           float first_moves) {
  const Lanes3 line = first - second;
  const Lanes length = lanes_sqrt(dot(line, line));
  const LaneMask has = length > 1e-9f;
  const Lanes share = has ? stiffness * (length - rest) / (has ? length : all_lanes(1)) : Lanes{};
  const Lanes3 force = line * share;
  first = first - force * all_lanes(first_moves);
  second = second + force * all_lanes(1 - first_moves);
}

}  // namespace

void relax_springs(BladeShapes& shapes, const BladeShapes& rest, const LaneMask& lanes,
                   float stiffness) {
  const Lanes along = keep_lanes(lanes, all_lanes(stiffness)), over = 0.25f * along;
  Lanes3* const joint = shapes.joint;
  for (int k = 0; k < segments; k++)
    relax(joint[k], joint[k + 1], shapes.length, along, k == 0 ? 0.0f : 0.5f);
  for (int k = 0; k + 2 < joints; k++) {
    const Lanes3 line = rest.joint[k] - rest.joint[k + 2];
    relax(joint[k], joint[k + 2], lanes_sqrt(dot(line, line)), over, k == 0 ? 0.0f : 0.5f);
  }
}

}  // namespace wellspring::lawn
