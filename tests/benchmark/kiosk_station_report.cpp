// SPDX-License-Identifier: Apache-2.0
// kiosk.station: how quickly and how surely a station tells what is held. Measured by a program of
// kiosk/.
#include "kiosk_program.h"
#include "reports.h"

namespace wellspring::test {

void bench_kiosk_station(BenchReport& report, const BenchOptions& options) {
  run_kiosk_program(report, options, "wellspring_kiosk_station");
}

ReportPage kiosk_station_page() {
  return {"kiosk.station",
          "How quickly and how surely does a station tell what is held to the camera? Objects that "
          "are made, 640x480, one core.",
          {"Wanted: 60 objects, cold at most 150 ms, coherent 15 ms (the paper: 192 and 24 at "
           "320x240 with 5 objects); 95 % of twins within 2 hints; no name where nothing is held.",
           "Cold: the first look at an object. Coherent: it was seen in the frame before. Both are "
           "the processor's time."},
          {{.caption = "Time of a look",
            .rows = {{"objects", "objects"}},
            .columns = {{"kiosk.station.cold_ms", "cold"},
                        {"kiosk.station.cold_p95_ms", "cold, 95 %"},
                        {"kiosk.station.coherent_ms", "coherent"},
                        {"kiosk.station.empty_ms", "nothing that was learnt"}},
            .most_rows = 3},
           {.caption = "Recordings of people who hold nothing, each at its own rate",
            .rows = {{"objects", "objects"}},
            .columns = {{"kiosk.station.people_seconds", "they last"},
                        {"kiosk.station.people_names", "names told"},
                        {"kiosk.station.people_cores", "processor"}},
            .most_rows = 1},
           {.caption = "Names, and calls of solvers",
            .rows = {{"objects", "objects"}},
            .columns = {{"kiosk.station.named", "named at once"},
                        {"kiosk.station.wrong", "named wrongly"},
                        {"kiosk.station.false", "named though nothing is held"},
                        {"kiosk.station.matches", "matches, cold"},
                        {"kiosk.station.often_matches", "of one that is often held"},
                        {"kiosk.station.most_matches", "most matches"}},
            .most_rows = 3},
           {.caption = "Twins",
            .rows = {{"told by", "told by"}},
            .columns = {{"kiosk.station.twins", "named within 2 hints"},
                        {"kiosk.station.twins_wrong", "named wrongly"},
                        {"kiosk.station.hints", "hints"}},
            .most_rows = 2}}};
}

}  // namespace wellspring::test
