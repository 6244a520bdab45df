// SPDX-License-Identifier: Apache-2.0
// kiosk.hands: how well bodies and hands are seen, and what that costs. Measured by a program of
// kiosk/.
#include "kiosk_program.h"
#include "reports.h"

namespace wellspring::test {

void bench_kiosk_hands(BenchReport& report, const BenchOptions& options) {
  run_kiosk_program(report, options, "wellspring_kiosk_limbs");
}

ReportPage kiosk_hands_page() {
  return {"kiosk.hands",
          "How well does the kiosk's eye see bodies and hands, and what does all of it cost? "
          "Recordings at 15 frames a second, one core; and hands that are made up.",
          {"Wanted: no body where nobody is; all of the eye below 0.6 of a core.",
           "Gestures of signing people are false: 17 s of sign language on video.",
           "Made hands: landmarks tremble by so much in the picture, and by thrice as much away "
           "from the camera. The ray goes from the eye, or from the finger's root, over its tip."},
          {{.caption = "Recordings: share of frames, and cost of the whole eye",
            .rows = {{"recordings", "recordings"}, {"by", "hands by"}},
            .columns = {{"kiosk.body.found", "with a body"},
                        {"kiosk.hand.found", "with a hand"},
                        {"kiosk.hand.false_a_minute", "false gestures, 1/min"},
                        {"kiosk.limbs_ms", "a frame, ms"},
                        {"kiosk.limbs_cores", "cores"}},
            .most_rows = 6},
           {.caption = "Bodies by recording, share of frames after two seconds",
            .rows = {{"clip", "clip"}},
            .columns = {{"kiosk.body.clip", "with a body"}},
            .most_rows = 9},
           {.caption = "Made hands",
            .rows = {{"trembling, mm", "trembling, mm"}},
            .columns = {{"kiosk.hand.counted", "fingers counted right"},
                        {"kiosk.hand.posed", "pose right"},
                        {"kiosk.hand.point_eye_deg", "from the eye, degrees off"},
                        {"kiosk.hand.point_finger_deg", "along the finger, degrees off"}},
            .most_rows = 4}}};
}

}  // namespace wellspring::test
