// SPDX-License-Identifier: Apache-2.0
// Samples by the point lights and photons of a pass that has begun (light/instant/instant_pass.h):
// the trace functions of technique `instant_radiosity` (light/technique/technique.h).
#pragma once
#include <span>

#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/transport_settings.h"

namespace wellspring::light {

Sample trace_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                     const Request& request);
void trace_many_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                        std::span<const Request> requests, std::span<Sample> samples);

}  // namespace wellspring::light
