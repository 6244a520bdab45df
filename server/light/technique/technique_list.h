// SPDX-License-Identifier: Apache-2.0
// The trace functions that technique.cpp lists, one file each; those of instant_radiosity are in
// light/instant/instant_radiosity.h.
#pragma once
#include <span>

#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/transport_settings.h"

namespace wellspring::light {

Sample trace_path(const World& world, const Lights& lights, const TransportSettings& settings,
                  const Request& request);
void trace_many_path(const World& world, const Lights& lights, const TransportSettings& settings,
                     std::span<const Request> requests, std::span<Sample> samples);
Sample trace_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request);
void trace_many_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples);
Sample trace_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request);
void trace_many_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples);
void prepare_gather(const World& world, std::span<const vec3> places, Lights& lights);
}  // namespace wellspring::light
