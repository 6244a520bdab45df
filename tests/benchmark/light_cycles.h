// SPDX-License-Identifier: Apache-2.0
// `path` against Blender's Cycles on the same glTF files: do they agree, and who is sooner at the
// same noise? Optional: without a `blender` on the PATH it says so and measures nothing.
#pragma once
#include "report.h"

namespace wellspring::test {

// Adds, one of each a case (cornell_box, metal_box, castle, castle_metals):
//   light.path.cycles_time_ratio          seconds of `path` over seconds of Cycles to the same RMSE
//   light.path.cycles_processor_ratio     the same in processor time of all threads
//   light.path.cycles_relative_mean       mean radiance over Cycles', less 1
//   light.path.cycles_block_z             root mean square of the difference of blocks of 8 x 8
//   pixels
//                                         over its standard error: 1 where there is nothing but
//                                         noise
//   light.path.cycles_block_correlation   of neighbouring blocks' differences: 0 without structure
void bench_light_cycles(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring::test
