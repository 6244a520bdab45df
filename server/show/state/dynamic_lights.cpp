// SPDX-License-Identifier: Apache-2.0
#include "show/state/dynamic_lights.h"

namespace wellspring {

DynamicLights dynamic_lights_of(const Show&, const Visitor&, double) { return {}; }

}  // namespace wellspring
