// SPDX-License-Identifier: Apache-2.0
// Programs of kiosk/ that measure, since OpenCV lives there alone: started, and their results taken
// over.
#pragma once
#include <string>

#include "report.h"

namespace wellspring::test {

// `name` is told where weights and recordings are, as far as there are any, and `more`. Throws
// std::runtime_error where it cannot be started or fails.
void run_kiosk_program(BenchReport& report, const BenchOptions& options, const std::string& name,
                       const std::string& more = "");

// A command that prints one JSON object a result: {"name","value","unit",...}. Throws likewise.
void read_results(BenchReport& report, const std::string& command);

}  // namespace wellspring::test
