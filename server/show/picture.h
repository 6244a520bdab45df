// SPDX-License-Identifier: Apache-2.0
// One picture for one visitor: view -> project -> attend -> plan -> trace -> remember -> reconstruct ->
// tonemap -> encode -> publish. The time left of the visitor's share of the tick is spent on samples.
#pragma once
#include "show/show.h"

namespace wellspring {

// Pictures a second this visitor should get.
double picture_rate(const Show& show, const Visitor& visitor);
// It is due, and the visitor's browser and socket can take it.
bool wants_picture(const Show& show, const Visitor& visitor);
// `busy` visitors share this tick's time.
void make_picture(Show& show, Visitor& visitor, int busy);

}  // namespace wellspring
