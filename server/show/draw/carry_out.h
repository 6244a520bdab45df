// SPDX-License-Identifier: Apache-2.0
// The renderer's work from tick to tick: takes what it has finished, and carries out what was
// decided (show/draw/decide.h) on the renderer. By the tick alone; never waits, but for draw_now().
#pragma once
#include "show/draw/decide.h"
#include "show/state/show.h"

namespace wellspring::show {

// What the renderer has finished. Returns whether it may be given the next: asked once a tick, as
// what it finishes later in the tick has not been taken.
bool take_finished(Show& show);
// `decision` is of show.visitors in their order, while the renderer is idle. `waiting` visitors
// share the time.
void carry_out(Show& show, const Decision& decision, int waiting);
// All that are due, one after the other, while the tick waits: where nothing is drawn in the
// background.
void draw_now(Show& show, int waiting);

}  // namespace wellspring::show
