// SPDX-License-Identifier: Apache-2.0
// Finds what a visitor's pictures may be at the moment.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Returns whether the visitor's socket and browser can take a picture.
bool takes_pictures(const Visitor& visitor, double time);
// Returns what this visitor would get if line, encoder and decoder set no limit.
FlowWishes flow_wishes(const ShowSettings& settings, const Visitor& visitor);
// The plan of a wall's camera has the rate of its slowest tile.
PicturePlan picture_plan(const ShowSettings& settings, const Visitor& visitor);

}  // namespace wellspring::show
