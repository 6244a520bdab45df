// SPDX-License-Identifier: Apache-2.0
// The visits' curves as SVG: to be read in a browser and beside the tables of docs/benchmarks.
#pragma once
#include <string>
#include <vector>

#include "cache_visit.h"

namespace wellspring::test {

// Mean FLIP over all traces against the renderer's budget, one curve a method.
void save_budget_plot(const std::string& file, const VisitResult& result,
                      const std::vector<int>& mismatches);
// FLIP over time at one mismatch ratio, a small diagram a trace.
void save_time_plot(const std::string& file, const VisitResult& result, int mismatch);

}  // namespace wellspring::test
