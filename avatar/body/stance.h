// SPDX-License-Identifier: Apache-2.0
// Where the body faces and where its feet stand. A turn is made in steps, one foot at a time; a
// foot that does not step does not move.
#pragma once
#include <array>

#include "avatar/figure/spring.h"

namespace wellspring::avatar {

struct Foot {
  float from = 0, to = 0;  // facing before and after the step, radians about +Y
  float phase = 1;         // 0..1 through the step; 1: planted
  float facing() const { return from + (to - from) * smooth_step(0, 1, phase); }
  float lift() const;  // metres
};

struct StanceState {
  std::array<Foot, 2> foot;  // left, right
  Spring heading;            // of the pelvis
  Spring lean;  // weight towards the standing foot while the other steps, metres to its left
  float wanted = 0;
  double turned_away =
      -1e30;  // since when what is looked at has been far to the side; < 0: it is not
};

// `aim`: yaw of what is looked at. `prior weight`: seconds and `reach`: angle before the body turns
// to it; reach < 0: nobody is looked at, and the body turns back to the front after `prior weight`.
// Without legs it just turns.
void tick_stance(StanceState& state, bool has_legs, float aim, float reach, float patience,
                 double now, float dt);

}  // namespace wellspring::avatar
