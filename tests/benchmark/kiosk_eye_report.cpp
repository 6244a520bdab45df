// SPDX-License-Identifier: Apache-2.0
// kiosk.eye: filters and landmarks compared, and the kiosk's program as a whole. Measured by a
// program of kiosk/.
#include "kiosk_program.h"
#include "reports.h"

namespace wellspring::test {

void bench_kiosk_eye(BenchReport& report, const BenchOptions& options) {
  run_kiosk_program(report, options, "wellspring_kiosk_compare",
                    "--kiosk '" + options.programs + "/wellspring_kiosk'");
}

ReportPage kiosk_eye_page() {
  return {
      "kiosk.eye",
      "What could the kiosk's eye be made of otherwise, and what does the whole program cost? "
      "Synthetic head at 640x480, 30 frames a second; recordings.",
      {"Filters get the same raw yaw: at rest (jitter: root mean square), and of a head that turns "
       "25 degrees to both sides in 2.5 s (lag: the delay with the least error; error: root mean "
       "square, without delay). One euro: cut-off at rest, beta. Kalman: constant velocity, "
       "noise of the acceleration in rad^2/s^3.",
       "Landmarks of dlib and of the kiosk's network: mean distance over that of the eyes. dlib's "
       "model learnt from pictures that are for research only, so the product does not use it.",
       "Wanted: an observation leaves the program at most 1.5 frame times after its picture was "
       "given to the eye's process; the memory of that process stays flat."},
      {{.caption = "Filters",
        .rows = {{"filter", "filter"}, {"setting", "setting"}},
        .columns = {{"kiosk.filter.jitter_deg", "jitter at rest"},
                    {"kiosk.filter.lag_ms", "lag"},
                    {"kiosk.filter.error_deg", "error in motion"}},
        .most_rows = 4},
       {.caption = "Landmarks of the same faces, over the distance of the eyes",
        .rows = {{"points", "points"}},
        .columns = {{"kiosk.marks.apart", "apart"}},
        .most_rows = 2},
       {.caption = "From picture to observation, in frame times of 1/30 s",
        .rows = {{"before it", "before the camera"}},
        .columns = {{"kiosk.way.frames_p50", "median"}, {"kiosk.way.frames_p95", "95 %"}},
        .most_rows = 2},
       {.caption = "Memory of the eye's process, after one simulated minute and at the end",
        .rows = {{"minutes", "minutes"}},
        .columns = {{"kiosk.memory.first_mib", "first"},
                    {"kiosk.memory.last_mib", "last"},
                    {"kiosk.memory.most_mib", "most"},
                    {"kiosk.memory.growth_mib", "growth"}},
        .most_rows = 1}}};
}

}  // namespace wellspring::test
