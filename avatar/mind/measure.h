// SPDX-License-Identifier: Apache-2.0
// How long a figure takes, for benchmarks.
#pragma once
#include "avatar/figure/character.h"

namespace wellspring {

struct AvatarTimes {
  double behave_ms = 0;  // tick_storyteller
  double skin_ms = 0;    // skin
};

// Medians over `ticks` ticks of an idling storyteller that speaks to a guest, on the calling
// thread's core alone.
AvatarTimes measure_avatar(const Character& character, int ticks = 300);

}  // namespace wellspring
