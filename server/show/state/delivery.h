// SPDX-License-Identifier: Apache-2.0
// What a visitor's pictures may be at the moment.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// What this visitor would get, were it not for line, encoder and decoder.
FlowWishes flow_wishes(const Show& show, const Visitor& visitor);
PicturePlan picture_plan(const Show& show, const Visitor& visitor);

}  // namespace wellspring::show
