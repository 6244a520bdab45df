// SPDX-License-Identifier: Apache-2.0
// What a technician reads in /metrics, and so on /status.
#include <gtest/gtest.h>

#include "show/answer/answer.h"

namespace wellspring {
namespace {

TEST(Metrics, tell_what_the_cameras_see_and_what_the_storyteller_is_about) {
  ShowReport report;
  report.audience = Presence::motion;
  report.mood = Mood::telling;
  const std::string text = write_metrics(report);
  for (const char* line :
       {"wellspring_audience{state=\"absent\"} 0\n", "wellspring_audience{state=\"motion\"} 1\n",
        "wellspring_storyteller_mood{state=\"telling\"} 1\n",
        "wellspring_storyteller_mood{state=\"idle\"} 0\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST(Metrics, name_a_kiosk_as_its_page_does) {
  ShowReport report;
  report.visitors.resize(2);
  report.visitors[0].id = 3;
  report.visitors[1].id = 4;
  report.visitors[1].kiosk = true;
  report.visitors[1].name = "hall \"1\"\\";
  report.visitors[1].decode_ms = 2.5f;
  const std::string text = write_metrics(report);
  for (const char* line :
       {"wellspring_visitor_decode_milliseconds{visitor=\"3\",role=\"visitor\"} 0\n",
        "wellspring_visitor_decode_milliseconds{visitor=\"4\",role=\"kiosk\",kiosk=\"hall '1''\"} "
        "2.5\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

}  // namespace
}  // namespace wellspring
