// SPDX-License-Identifier: Apache-2.0
// Finds what a visitor's pictures may be at the moment.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Returns what this visitor would get if line, encoder and decoder set no limit.
FlowWishes flow_wishes(const ShowSettings& settings, const Visitor& visitor);
PicturePlan picture_plan(const ShowSettings& settings, const Visitor& visitor);

}  // namespace wellspring::show
