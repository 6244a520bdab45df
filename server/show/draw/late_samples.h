// SPDX-License-Identifier: Apache-2.0
// What pictures of walking visitors have asked for, in turn, in the time that was left for it: the
// answers are in the next ones. Likewise in three steps (show/draw/picture.h).
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// By the tick, while the renderer is idle. Says whether there is anything.
bool request_samples(Show& show);
// On the renderer.
void trace_samples(const Show& show, Renderer& renderer);
// By the tick, when that is done.
void finish_samples(Show& show);

}  // namespace wellspring::show
