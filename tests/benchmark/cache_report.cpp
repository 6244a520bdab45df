// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "cache_display.h"
#include "report.h"

namespace wellspring::test {

void bench_cache_display(BenchReport& report, const BenchOptions& options) {
  constexpr int width = 1280, height = 720;
  for (const NamedValue& value : report_cache_display(width, height, options.quick)) {
    nlohmann::json fields = {{"size", "1280x720"}};
    if (!value.stage.empty()) fields["stage"] = value.stage;
    report.add(value.name, value.value, value.unit, fields);
  }
  // These sizes show whether time grows with pixels alone.
  for (auto [across, down] : {std::pair(640, 360), std::pair(1920, 1080)})
    for (const NamedValue& value : report_cache_display(across, down, options.quick)) {
      bool one_core = value.name == "cache.display.ms_one_core";
      if (!one_core && value.name != "cache.display.ms") continue;
      report.add(one_core ? "cache.display.size_ms_one_core" : "cache.display.size_ms", value.value,
                 value.unit, {{"size", std::to_string(across) + "x" + std::to_string(down)}});
    }
}

}  // namespace wellspring::test
