// SPDX-License-Identifier: Apache-2.0
// Technique `path`: unbiased path tracing, the reference.
#include "light/technique_list.h"
#include "light/walk.h"

namespace wellspring {

Sample trace_path(const World& world, const Lights& lights, const TransportSettings& settings,
                  const Request& request) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  return finish_sample(lights, settings, trace_sample({world, *lights.tables}, rules, request));
}

}  // namespace wellspring
