// SPDX-License-Identifier: Apache-2.0
// Advances the whole of a running show, in one straight function of visible values: notice ->
// behave -> animate -> (per visitor) picture.
#pragma once
#include "show/state/arrivals.h"
#include "show/state/show.h"

namespace wellspring::show {

// Makes one step at time `now` (seconds, any clock that does not run backwards; steps longer than a
// second are taken as one second). Never throws, never waits for a peer.
void tick(Show& show, Arrivals& arrivals, double now);

// Returns whether somebody is there, and something was drawn for them lately: the cores are not
// free then.
bool draws(const ShowVisits& visits, const ShowDrawing& drawing, double time);

// Returns how long the caller may sleep after a tick, at time `now` on the same clock.
double seconds_to_next_tick(const Show& show, double now);
// Sleeps until the next tick is due, or what is drawn meanwhile is finished.
void wait_for_tick(const Show& show, double now);

}  // namespace wellspring::show
