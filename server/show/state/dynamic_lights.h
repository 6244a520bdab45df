// SPDX-License-Identifier: Apache-2.0
// The lights of a visitor that move or change (light/dynamic/dynamic_light.h): those of
// exhibit.json, at the visitor's hour of the day, and those that the visitor's teller carries.
#pragma once
#include "light/dynamic/dynamic_light.h"
#include "show/state/show.h"

namespace wellspring {

// As they are at `time`, seconds of the show. Empty, at no cost, where the exhibit has none.
DynamicLights dynamic_lights_of(const Show& show, const Visitor& visitor, double time);

}  // namespace wellspring
