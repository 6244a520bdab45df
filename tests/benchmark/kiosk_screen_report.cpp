// SPDX-License-Identifier: Apache-2.0
// kiosk.page: how quickly the kiosk's well is drawn, in Chromium. Measured by a script.
#include <cstdio>
#include <filesystem>

#include "kiosk_program.h"
#include "reports.h"

namespace wellspring::test {

void bench_kiosk_screen(BenchReport& report, const BenchOptions& options) {
  namespace fs = std::filesystem;
  const fs::path modules = fs::path(options.programs) / ".." / "node";
  if (!fs::exists(modules / "node_modules" / "playwright-core")) {
    std::fprintf(stderr, "kiosk.page: no playwright-core in %s: ./wellspring test installs it\n",
                 modules.c_str());
    return;
  }
  const fs::path script = fs::path(options.scenes) / ".." / "well.mjs";
  read_results(report, "node '" + script.string() + "' '" + options.web + "' '" + modules.string() +
                           "'" + (options.quick ? " --quick" : ""));
}

ReportPage kiosk_screen_page() {
  return {
      "kiosk.page",
      "How quickly is the well of the kiosk's screen drawn? Chromium, touched eight times a "
      "second.",
      {"Wanted: 60 pictures a second, 16.7 ms, on modest graphics hardware. `card` none: the "
       "processor draws, which the product does not ask of it: such a screen shows a still well.",
       "The water is computed by the processor in any case, a step of 1/120 s at a time."},
      {{.caption = "From picture to picture",
        .rows = {{"pixels", "pixels"}, {"card", "graphics card"}},
        .columns = {{"kiosk.page.frame_ms", "median"}, {"kiosk.page.frame_p95_ms", "95 %"}},
        .most_rows = 3},
       {.caption = "Water of a picture at 60 a second",
        .columns = {{"kiosk.page.water_ms", "time"}},
        .most_rows = 1}}};
}

}  // namespace wellspring::test
