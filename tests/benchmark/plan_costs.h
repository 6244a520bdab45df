// SPDX-License-Identifier: Apache-2.0
// Measures what a server's work costs on this machine, for plan/costs.h: of a server with one
// visitor, and of single functions. No figure comes from servers with many visitors but one: what
// each visitor adds to a tick.
#pragma once
#include "report.h"

namespace wellspring::test {

// Adds the rows "load.plan.cost.*". Throws std::runtime_error if a server does not start.
void measure_plan_costs(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring::test
