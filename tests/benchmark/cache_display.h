// SPDX-License-Identifier: Apache-2.0
// How long the render cache's display process takes: move_points, project, attend, plan, remember
// and reconstruct, without the tracing, of a visitor who strolls through a hall.
#pragma once
#include <string>
#include <vector>

namespace wellspring::test {

struct NamedValue {
  std::string name, unit;
  double value = 0;
  std::string stage = {};  // which stage of cache.display.stage_ms
};

// cache.display.ms (all cores), .ms_one_core, .yardstick_ms_one_core (the bare loop "transform,
// divide, z-test, store" over as many points), .yardstick_ratio (one core over the yardstick),
// .stage_ms (each stage on one core) and .memory. Medians over the frames of a stroll once the
// cache is full; on one core of processor time, on all cores of the clock's.
std::vector<NamedValue> report_cache_display(int width, int height, bool quick);

}  // namespace wellspring::test
