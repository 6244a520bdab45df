// SPDX-License-Identifier: Apache-2.0
// What a technician reads in /metrics, and so on /status.
#include <gtest/gtest.h>

#include "show/http/answer.h"

namespace wellspring::test {
namespace {

TEST(Metrics, tell_what_the_cameras_see_and_what_the_storyteller_is_about) {
  ShowReport report{.audience = Presence::motion, .mood = Mood::telling};
  const std::string text = write_metrics(report);
  for (const char* line :
       {"wellspring_audience{state=\"absent\"} 0\n", "wellspring_audience{state=\"motion\"} 1\n",
        "wellspring_storyteller_mood{state=\"telling\"} 1\n",
        "wellspring_storyteller_mood{state=\"idle\"} 0\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST(Metrics, tell_how_the_house_is) {
  ShowReport report;
  const std::string open = write_metrics(report);
  EXPECT_NE(open.find("\nwellspring_house_open 1\n"), std::string::npos);
  EXPECT_NE(open.find("\nwellspring_house_quiet 0\n"), std::string::npos);
  report.open = false;
  report.quiet = true;
  report.totals.announcements = 3;
  const std::string closed = write_metrics(report);
  for (const char* line : {"\nwellspring_house_open 0\n", "\nwellspring_house_quiet 1\n",
                           "\nwellspring_announcements_total 3\n"})
    EXPECT_NE(closed.find(line), std::string::npos) << line;
}

TEST(Metrics, tell_of_each_kiosk_by_its_name) {
  ShowReport report;
  EXPECT_EQ(write_metrics(report).find("kiosk_stage"), std::string::npos);
  report.kiosks = {{"hall", Stage::engaged, 2, true}, {"attic", Stage::sleep, 0, false}};
  report.cameras = {{"attic", 1, "", "dark", 12}};
  report.connected_cameras = 1;
  const std::string text = write_metrics(report);
  for (const char* line :
       {"wellspring_kiosk_stage{kiosk=\"hall\",stage=\"engaged\"} 1\n",
        "wellspring_kiosk_stage{kiosk=\"hall\",stage=\"sleep\"} 0\n",
        "wellspring_kiosk_stage{kiosk=\"attic\",stage=\"sleep\"} 1\n",
        "wellspring_kiosk_people{kiosk=\"hall\"} 2\n", "wellspring_kiosk_cameras 1\n",
        "wellspring_kiosk_storyteller{kiosk=\"hall\"} 1\n",
        "wellspring_kiosk_storyteller{kiosk=\"attic\"} 0\n",
        "wellspring_kiosk_camera_seconds{kiosk=\"attic\",camera=\"1\",state=\"dark\"} 12\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
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

TEST(Metrics, of_several_exhibits_are_told_apart_and_each_name_is_explained_once) {
  const std::string a =
      "# HELP x Of all\n# TYPE x gauge\nx 1\n# HELP y By kind\n# TYPE y gauge\ny{k=\"a b\"} 2\n";
  const std::string b = "# HELP x Of all\n# TYPE x gauge\nx 3\n# TYPE z counter\nz 4\n";
  EXPECT_EQ(join_metrics({{"mill", a}, {"castle", b}}),
            "# HELP x Of all\n# TYPE x gauge\nx{exhibit=\"mill\"} 1\nx{exhibit=\"castle\"} 3\n"
            "# HELP y By kind\n# TYPE y gauge\ny{exhibit=\"mill\",k=\"a b\"} 2\n"
            "# TYPE z counter\nz{exhibit=\"castle\"} 4\n");
  EXPECT_EQ(failure_metrics({}), "");
  EXPECT_NE(failure_metrics({{"ruin", {"x.json: \"bad\"", "more"}}})
                .find("wellspring_exhibit_failed{exhibit=\"ruin\",problem=\"x.json: 'bad'\"} 1\n"),
            std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
