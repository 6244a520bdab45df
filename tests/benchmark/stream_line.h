// SPDX-License-Identifier: Apache-2.0
// stream.shaped.*: a visitor at the end of a slow line.
#pragma once
#include "report.h"

namespace wellspring::test {

void bench_line(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring::test
