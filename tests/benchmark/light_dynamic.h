// SPDX-License-Identifier: Apache-2.0
// What the light of a torch costs that moves through the castle's hall, and how right it is.
#pragma once
#include "report.h"

namespace wellspring::test {

// `light.dynamic`: pictures of 1280x720 of the hall by night with a torch at eight places. Of each
// number of virtual lights the processor time of a picture in its stages, and FLIP against `path`
// of two edges after the eye's. Flicker: how much the light of a place changes from picture to
// picture beyond how it should.
void bench_light_dynamic(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring::test
