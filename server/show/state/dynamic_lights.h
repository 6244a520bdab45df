// SPDX-License-Identifier: Apache-2.0
// The lights of a visitor that move or change (light/dynamic/dynamic_light.h): those of
// exhibit.json, at the visitor's hour of the day, and those that the visitor's teller carries.
#pragma once
#include "light/dynamic/dynamic_light.h"
#include "show/state/show.h"

namespace wellspring::show {

// DynamicLight::id: of exhibit.lights their place there and this, and of the others.
inline constexpr uint32_t first_changing_light = 1, sun_of_the_day = 1000, first_carried = 2000;

// As they are at `time`, seconds of the show. Empty, at no cost, where the exhibit has none.
DynamicLights dynamic_lights_of(const Show& show, const Visitor& visitor, double time);
// Those that may shine on what the view shows: one of finite range only within that.
DynamicLights dynamic_lights_in(const View& view, DynamicLights lights);

}  // namespace wellspring::show
