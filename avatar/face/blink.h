// SPDX-License-Identifier: Apache-2.0
// Blinks: every 2 to 5 seconds, sometimes twice, 70 ms down and 120 ms up. State is a value.
#pragma once
#include "base/rng.h"

namespace wellspring::avatar {

struct BlinkState {
  double next = 1.5;     // when the coming blink starts
  double begun = -1e30;  // when the last one did
  bool twice = false;    // the coming blink is the second of a pair
  long count = 0;
};

// How far the lids are closed, 0..1. `humanlike` false: one blink every 4 seconds.
float tick_blink(BlinkState& state, Rng& rng, double now, bool humanlike);
// A blink now unless one is under way or has just been: the eyes blink with a large turn of the
// gaze.
void ask_blink(BlinkState& state, double now);

}  // namespace wellspring::avatar
