// SPDX-License-Identifier: Apache-2.0
// What caustic photons cost a frame.
#pragma once
#include "report.h"

namespace wellspring::test {

// `light.caustics.photons_ms` (`--only light.photons`): 100,000 photons stored in the grids of 3 x
// 3 interleaved sets and asked once for every pixel of 640x480 that sees a surface, tile by tile as
// the technique does: processor time shared by 4 cores (`store_cpu_ms`, `query_cpu_ms` are all of
// it), and beside it `shoot_ms` of tracing them.
void bench_light_photons(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring::test
