// SPDX-License-Identifier: Apache-2.0
// Technique `direct`: emission and the light that reaches a surface straight, seen also in chains
// of perfect mirrors and glass. No light between rough surfaces.
#include "light/technique_list.h"
#include "light/walk.h"

namespace wellspring {

Sample trace_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  rules.scatterings = 1;
  return finish_sample(lights, settings, trace_sample({world, *lights.tables}, rules, request));
}

}  // namespace wellspring
