// SPDX-License-Identifier: Apache-2.0
// One picture for one visitor: view -> project -> attend -> plan -> trace -> remember -> reconstruct ->
// tonemap -> encode -> publish. The time left of the visitor's share of the tick is spent on samples; those
// of a walking visitor are traced when its picture is on its way, and land in the next.
#pragma once
#include "show/show.h"

namespace wellspring {

// Pictures a second this visitor should get.
double picture_rate(const Show& show, const Visitor& visitor);
// It is due, and the visitor's browser and socket can take it.
bool wants_picture(const Show& show, const Visitor& visitor);
// `busy` visitors share this tick's time.
void make_picture(Show& show, Visitor& visitor, int busy);
// What pictures of walking visitors have asked for, in turn, in the time that was left for it: their
// pictures are on their way already, and the answers are in the next ones.
void trace_for_next(Show& show);

}  // namespace wellspring
