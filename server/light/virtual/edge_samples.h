// SPDX-License-Identifier: Apache-2.0
// Sends more rays from the eye to edges: light is smooth and costs most, surfaces and colours that
// reflect it end sharply and cost little. After the discontinuity buffer, pixels whose neighbours
// show another surface or another colour get more rays; each finds a surface and takes the light of
// the nearest pixel that shows the same one. If no pixel does, the ray's place is lit by itself.
// (The paper of instant_radiosity.h antialiases by accumulating pictures alone, section 4.)
#pragma once
#include <span>

#include "light/virtual/discontinuity_buffer.h"
#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/transport_plan.h"
#include "world/view.h"

namespace wellspring::light {

// Makes samples[y * width + x], filtered, means over `rays` more samples a pixel at `edges`, which
// are filter_windows()'s. `lights.pass` is the pass they were traced in.
void refine_edges(const World& world, const Lights& lights, const TransportSettings& settings,
                  const View& view, const DiscontinuitySettings& continuity, int rays,
                  uint64_t seed, uint32_t index, std::span<const uint8_t> edges,
                  std::span<Sample> samples);

// Answers requests by the point lights and photons of a pass that has begun
// (light/virtual/instant_pass.h): the trace functions of technique `instant_radiosity`
// (light/technique/technique.h).

Sample trace_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                     const Request& request);
void trace_many_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                        std::span<const Request> requests, std::span<Sample> samples);

}  // namespace wellspring::light
