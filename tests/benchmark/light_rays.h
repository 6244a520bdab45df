// SPDX-License-Identifier: Apache-2.0
// Rays a second of `path` against the path tracer that comes with Embree, both on its Cornell box
// at 1280x720, in turns in one run. Skipped, and said so, where that program is not installed.
//
// The scene is the other program's own (cornell_box.obj and cornell_box.ecs of the package
// embree-tools): its quads, its diffuse colours, its one point light, its camera, and paths as
// long as its own, eight vertices. A ray is any query for a nearest hit or for an occluder. Both
// sides leave out shadow rays that they do not trace. The other program's count is taken as it
// prints it (BENCHMARK_RENDER_MRAYPS_AVG). Ours are counted by tracing the same samples again on
// one thread, untimed.
#pragma once
#include "report.h"

namespace wellspring::test {

// Adds light.path.rays_ratio and light.path.rays_processor_ratio (by the clock and in processor
// time; medians over turns), and each side's rays a second.
void bench_light_rays(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring::test
