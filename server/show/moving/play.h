// SPDX-License-Identifier: Apache-2.0
// How far an animation has come. One that loops runs by the show's clock; one that is started by
// touch runs to its end and stays there, until it is touched again and runs back.
#pragma once
#include "show/exhibit/exhibit.h"

namespace wellspring::show {

// Of an animation that is started by touch. Times are show times.
struct Play {
  bool on = false;      // it is at its end, or on the way there
  double from = 0;      // seconds of the animation, at the last touch
  double since = -1e9;  // when that was
};

// Seconds of the animation.
double time_of(const ExhibitAnimation& animation, const Play& play, double now);
bool is_running(const ExhibitAnimation& animation, const Play& play, double now);
void set_on(const ExhibitAnimation& animation, bool on, double now, Play& play);

}  // namespace wellspring::show
