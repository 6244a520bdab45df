// SPDX-License-Identifier: Apache-2.0
// Technique `path`: unbiased path tracing, the reference.
#include "light/sample/finish_samples.h"
#include "light/technique/technique_list.h"
#include "light/walk/walk.h"

namespace wellspring::light {

void trace_many_path(const World& world, const Lights& lights, const TransportSettings& settings,
                     std::span<const Request> requests, std::span<Sample> samples) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  Transport transport{world, *lights.tables};
  transport.maps = lights.maps.get();
  trace_samples(transport, rules, requests, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_path(const World& world, const Lights& lights, const TransportSettings& settings,
                  const Request& request) {
  Sample sample;
  trace_many_path(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

}  // namespace wellspring::light
