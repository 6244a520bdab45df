// SPDX-License-Identifier: Apache-2.0
// Pages of the reports on how many visitors a machine serves.
#include "reports.h"

namespace wellspring::test {

ReportPage load_visitors_page() {
  return {"load.visitors",
          "How many visitors does a machine serve? All stroll through the castle at 640x360, and "
          "share the cores with the server.",
          {"Fairness: pictures of whoever got the fewest, over those of whoever got the most.",
           "Wanted on four cores: 15 pictures a second for each of 24, 120 ms, fairness 0.8."},
          {{.caption = "",
            .rows = {{"visitors", "visitors"}},
            .columns = {{"fps", "pictures a second of each, median", 1, "1/s"},
                        {"fairness", "fairness"},
                        {"latency_p50_ms", "input to picture, median"},
                        {"latency_p95_ms", "input to picture, 95th percentile"},
                        {"longest_gap_ms", "longest time without a picture"},
                        {"server_memory", "memory of the server"}}}}};
}

ReportPage load_seats_page() {
  return {
      "load.seats",
      "How many visitors does a machine seat whose pages draw by themselves? They stroll through "
      "the castle, and share the cores with the server.",
      {"Rate: keyframes, or finished pictures, for each second in which a visitor walks.",
       "Fairness: those of whoever got the fewest, over those of whoever got the most.",
       "Cores: that the server took, of all. Seats: what it says (1280x720, local) by then.",
       "Wanted on two cores, all walking: 4 at 1280x720 with 6 a second, 8 with 3, 20 at 640x360 "
       "with 4, fairness 0.85; a third walking: 12 seats at 1280x720."},
      {{.caption = "",
        .rows = {{"visitors", "visitors"},
                 {"size", "size"},
                 {"walking", "walking"},
                 {"display", "display"}},
        .columns = {{"rate", "of each, median", 1, "1/s"},
                    {"least_rate", "of whoever got the fewest", 1, "1/s"},
                    {"fairness", "fairness"},
                    {"longest_gap_ms", "longest time without one"},
                    {"picture_bytes", "one, median", 1e-3, "kB"},
                    {"bandwidth", "of each"},
                    {"cores", "cores"},
                    {"seats", "seats"},
                    {"server_memory", "memory of the server"}}}}};
}

ReportPage load_plan_page() {
  const std::vector<PageColumn> both = {{"p50", "median", 1, "ms"},
                                        {"p50_ratio", "said over it"},
                                        {"p95", "95th percentile", 1, "ms"},
                                        {"p95_ratio", "said over it"},
                                        {"keyframes", "keyframes a second of each"},
                                        {"keyframes_ratio", "said over it"},
                                        {"pictures", "pictures a second of each"},
                                        {"pictures_ratio", "said over it"},
                                        {"load.plan.others", "other programs' threads"}};
  return {
      "load.plan",
      "How many machines does a museum need? `./wellspring plan --visitors N` says it by a "
      "simulation (server/plan) with costs that are measured here with one visitor.",
      {"The check: a stroll through the castle, from an input to its picture.",
       "Museums: half of the time is walked, at 1280x720, local; 3 keyframes a second, 1,000 ms."},
      {{.caption = "The check, on this machine",
        .rows = {{"display", "display"}, {"size", "size"}, {"visitors", "visitors"}},
        .columns = both,
        .most_rows = 20},
       {.caption = "What to buy; `gives out`: what has the least left with one visitor more",
        .rows = {{"cores", "cores of a server"}, {"visitors", "visitors at the peak"}},
        .columns = {{"servers", "servers"},
                    {"each", "visitors of each, at most"},
                    {"each", "gives out", 1, "", "gives_out"},
                    {"memory", "memory of each"},
                    {"museum_line", "line of the museum"},
                    {"expected_p95", "expected, 95th percentile"},
                    {"expected_keyframes", "keyframes a second"}},
        .most_rows = 9}}};
}

}  // namespace wellspring::test
