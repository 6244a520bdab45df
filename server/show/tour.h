// SPDX-License-Identifier: Apache-2.0
// A guided ride between viewpoints: eased, without roll, interruptible. A value advanced by time.
#pragma once
#include "show/exhibit.h"

namespace wellspring {

struct TourRide {
  enum class State : uint8_t { none, playing, paused } state = State::none;
  int tour = -1;
  int stop = 0;         // travelling to or staying at this stop
  bool staying = false;
  float elapsed = 0;    // seconds of the present leg or stay
  Viewpoint from;       // where the present leg began
};

struct TourStep {
  Viewpoint view;        // where the visitor is now
  int arrived = -1;      // stop reached in this step, if any
  bool finished = false;
};

// Starts (or, when paused, resumes) from the visitor's present place.
void start_tour(TourRide& ride, int tour, const Viewpoint& from);
// Moves on by `dt` seconds; any dt is safe, one step passes at most one leg.
TourStep advance_tour(TourRide& ride, const Exhibit& exhibit, float dt);

// Between two places: position eased by a quintic, yaw the short way round.
Viewpoint blend_viewpoints(const Viewpoint& a, const Viewpoint& b, float t);

}  // namespace wellspring
