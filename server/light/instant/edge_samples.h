// SPDX-License-Identifier: Apache-2.0
// More rays from the eye where a picture needs them: light is smooth and costs most, what reflects
// it ends sharply and costs little. After the discontinuity buffer, pixels whose neighbours show
// another surface or another colour get more rays; each finds out what it shows and takes the light
// of the nearest pixel that shows the same surface. Where none does, it is lit by itself. (The
// paper of instant_radiosity.h antialiases by accumulating pictures alone, section 4.)
#pragma once
#include <span>

#include "light/instant/discontinuity_buffer.h"
#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/transport_plan.h"
#include "world/view.h"

namespace wellspring::light {

// samples[y * width + x], filtered, become means over `rays` more samples a pixel at `edges`,
// filter_windows()'s. `lights.pass` is the pass they were traced in.
void refine_edges(const World& world, const Lights& lights, const TransportSettings& settings,
                  const View& view, const DiscontinuitySettings& continuity, int rays,
                  uint64_t seed, uint32_t index, std::span<const uint8_t> edges,
                  std::span<Sample> samples);

// Samples by the point lights and photons of a pass that has begun (light/instant/instant_pass.h):
// the trace functions of technique `instant_radiosity` (light/technique/technique.h).

Sample trace_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                     const Request& request);
void trace_many_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                        std::span<const Request> requests, std::span<Sample> samples);

}  // namespace wellspring::light
