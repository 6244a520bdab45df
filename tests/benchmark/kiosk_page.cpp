// SPDX-License-Identifier: Apache-2.0
// What the pages of the kiosk's reports show.
#include "reports.h"

namespace wellspring::test {

ReportPage kiosk_gestures_page() {
  const std::vector<PageKey> vocabulary = {{"vocabulary", "vocabulary"}};
  return {
      "kiosk.gestures",
      "How well are gestures of one hand recognised, alone and within continuous motion, of "
      "persons "
      "whom no model has seen? Persons and movements are made up; no visitor was recorded.",
      {"Alone: right of all. Spotted: right over tests and insertions. Paper: 97.78 and 93.31 %.",
       "digits: 0 to 9, as in the paper; all: also wave, point and four swipes.",
       "Other motion: scratching, talking, reaching, going from place to place without a break. "
       "Signing: 17 s of sign language on video, through the whole kiosk program."},
      {{.caption = "",
        .rows = {{"vocabulary", "vocabulary"}, {"method", "method"}},
        .columns = {{"isolated", "alone", 100, "%"},
                    {"spotting", "spotted", 100, "%"},
                    {"tests", "gestures", 1, ""},
                    {"inserted", "inserted", 1, ""},
                    {"deleted", "deleted", 1, ""},
                    {"substituted", "substituted", 1, ""},
                    {"false_a_minute", "false in other motion"},
                    {"false_signing_a_minute", "false in signing"},
                    {"us_a_frame", "a frame"}},
        .most_rows = 6},
       {.caption = "Each gesture spotted, %",
        .rows = vocabulary,
        .columns = {{"spotting_each", "", 100, "%"}},
        .across = "gesture",
        .most_rows = 2},
       {.caption = "Spotted over the size of the window, %",
        .rows = {{"vocabulary", "vocabulary"}, {"method", "method"}},
        .columns = {{"by_window", "", 100, "%"}},
        .across = "window",
        .most_rows = 4},
       {.caption = "Spotted over the margin, %",
        .rows = vocabulary,
        .columns = {{"by_margin", "", 100, "%"}},
        .across = "margin",
        .most_rows = 2}}};
}

}  // namespace wellspring::test
