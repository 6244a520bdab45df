// SPDX-License-Identifier: Apache-2.0
// What the light of a torch costs that moves through the castle's hall, and how right it is.
#pragma once
#include "report.h"

namespace wellspring::test {

// `light.dynamic`: pictures of 1280x720 of the hall by night with a torch at eight places. For each
// number of virtual lights it measures the processor time of a picture in its stages, and FLIP
// against `path` of two edges after the eye's. Flicker: how much more a place's light changes from
// picture to picture than it should.
void bench_light_dynamic(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring::test
