// SPDX-License-Identifier: Apache-2.0
// The trace functions that technique.cpp lists, one file each, and the gate that every sample
// passes.
#pragma once
#include "light/technique.h"

namespace wellspring {

Sample trace_path(const World& world, const Lights& lights, const TransportSettings& settings,
                  const Request& request);
Sample trace_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request);
Sample trace_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request);
void prepare_gather(const World& world, std::span<const vec3> places, Lights& lights);

// A sample fit for a Frame: light that is NaN, infinite or negative is dropped (black) and counted;
// settings.clamp is applied.
Sample finish_sample(const Lights& lights, const TransportSettings& settings, Sample sample);

}  // namespace wellspring
