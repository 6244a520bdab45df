// SPDX-License-Identifier: Apache-2.0
#include "cache_display.h"
#include "report.h"

namespace wellspring {

void bench_cache_display(BenchReport& report, const BenchOptions& options) {
  constexpr int width = 1280, height = 720;
  for (const NamedValue& value : report_cache_display(width, height, options.quick)) {
    nlohmann::json fields = {{"size", "1280x720"}};
    if (!value.stage.empty()) fields["stage"] = value.stage;
    report.add(value.name, value.value, value.unit, fields);
  }
}

}  // namespace wellspring
