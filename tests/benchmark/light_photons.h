// SPDX-License-Identifier: Apache-2.0
// What caustic photons cost a frame.
#pragma once
#include "report.h"

namespace wellspring {

// `light.caustics.photons_ms`: 100,000 photons stored in the grids of 3 x 3 interleaved sets and asked
// once for every pixel of 640x480 that sees a surface; `store_ms`, `query_ms`, and beside them
// `shoot_ms` of tracing them.
void bench_light_photons(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring
