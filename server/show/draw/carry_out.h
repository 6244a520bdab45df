// SPDX-License-Identifier: Apache-2.0
// Drives the renderer from tick to tick: takes what it has finished, and carries out on it what was
// decided (show/draw/decide.h). By the tick alone; never waits.
#pragma once
#include "show/draw/decide.h"
#include "show/state/show.h"

namespace wellspring::show {

// Takes what the renderer has finished. Returns whether the renderer may be given the next: call it
// once a tick, as what is finished later in the tick has not been taken.
bool take_finished(Show& show);
// Carries out a decision on show.visits.visitors in their order, while the renderer is idle.
// `waiting` visitors share the time.
void carry_out(Show& show, const Decision& decision, int waiting);

}  // namespace wellspring::show
