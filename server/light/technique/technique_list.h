// SPDX-License-Identifier: Apache-2.0
// The trace functions that technique.cpp lists, one file each, and the gate that every sample
// passes.
#pragma once
#include "light/technique/technique.h"

namespace wellspring {

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
Sample trace_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                     const Request& request);
void trace_many_instant(const World& world, const Lights& lights,
                        const TransportSettings& settings, std::span<const Request> requests,
                        std::span<Sample> samples);
void begin_instant(const World& world, const TransportSettings& settings, const View& view,
                   uint64_t seed, uint32_t index, Lights& lights);
void finish_instant(const World& world, const Lights& lights, const View& view,
                    std::span<Sample> samples);

// Makes samples fit for a Frame: light that is NaN, infinite or negative is dropped (black) and
// counted; settings.clamp is applied.
void finish_samples(const Lights& lights, const TransportSettings& settings,
                    std::span<Sample> samples);
inline Sample finish_sample(const Lights& lights, const TransportSettings& settings,
                            Sample sample) {
  finish_samples(lights, settings, std::span(&sample, 1));
  return sample;
}

}  // namespace wellspring
