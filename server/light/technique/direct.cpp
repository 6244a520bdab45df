// SPDX-License-Identifier: Apache-2.0
// Technique `direct`: emission and the light that reaches a surface straight, seen also in chains
// of perfect mirrors and glass. No light between rough surfaces.
#include "light/sample/finish_samples.h"
#include "light/technique/technique_list.h"
#include "light/walk/walk.h"

namespace wellspring::light {

void trace_many_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  rules.scatterings = 1;
  trace_samples({world, *lights.tables}, rules, requests, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request) {
  Sample sample;
  trace_many_direct(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

}  // namespace wellspring::light
