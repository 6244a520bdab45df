// SPDX-License-Identifier: Apache-2.0
// What of scripted visits is counted, and for which day.
#include "show/count/count.h"

#include "unit/show/kiosk_house.h"

namespace wellspring::test {
namespace {

struct Counts : KioskHouse {
  void SetUp() override {
    KioskHouse::SetUp();
    show->house.local_time.day = 20000;
  }
  double sum(const char* what, const std::string& key, int64_t day = 20000) const {
    auto found = show->sums.find({day, what, key});
    return found == show->sums.end() ? 0 : found->second;
  }
  size_t of(const std::string& what) const {  // how many keys
    size_t count = 0;
    for (const auto& [key, value] : show->sums) count += key.what == what;
    return count;
  }
};

TEST_F(Counts, VisitsAndTheirLanguagesOnce) {
  join(32, 32, "de");
  const size_t second = join(32, 32, "en");
  say(R"({"type":"hello","exhibit":"","width":32,"height":32,"lang":"en","role":"visitor"})",
      second);
  go(0.2);
  page("hall");
  EXPECT_EQ(sum("visits", "tiny"), 2) << "a kiosk's screen is nobody";
  EXPECT_EQ(sum("languages", "tiny/de"), 1);
  EXPECT_EQ(sum("languages", "tiny/en"), 1);
}

TEST_F(Counts, LanguagesThatTheExhibitDoesNotSpeakAreOne) {
  for (const char* tag : {"de-AT", "fr", "xx-made-up"}) join(32, 32, tag);
  go(0.2);
  EXPECT_EQ(sum("languages", "tiny/de"), 1);
  EXPECT_EQ(sum("languages", "tiny/other"), 2);
  EXPECT_EQ(of("languages"), 2u);
}

TEST_F(Counts, MidnightBeginsADay) {
  join(32, 32);
  go(0.1);
  show->house.local_time.day = 20001;
  join(32, 32);
  join(32, 32);
  go(0.1);
  EXPECT_EQ(sum("visits", "tiny", 20000), 1);
  EXPECT_EQ(sum("visits", "tiny", 20001), 2);
}

TEST_F(Counts, SecondsAtTheNearestViewpoint) {
  const size_t visitor = join(32, 32);
  const double before = sum("dwell_seconds", "tiny/door");
  go(4);
  EXPECT_NEAR(sum("dwell_seconds", "tiny/door") - before, 4, 0.1);
  say(R"({"type":"viewpoint","seq":1,"name":"corner"})", visitor);
  go(2);
  EXPECT_NEAR(sum("dwell_seconds", "tiny/corner"), 2, 0.2);
  EXPECT_NEAR(sum("dwell_seconds", "tiny/door") - before, 4, 0.2);
  say(R"({"type":"camera","seq":2,"position":[0,40,0],"yaw":0,"pitch":0})", visitor);
  go(1);
  EXPECT_NEAR(sum("dwell_seconds", "tiny/-"), 1, 0.2) << "far from all of them";
}

TEST_F(Counts, NobodyIsThereWhoHasNotMovedForLong) {
  show->settings.idle_after = 0;  // else the visit would rest by then
  join(32, 32);
  for (int i = 0; i < 900; i++) step(1.0);
  EXPECT_NEAR(sum("dwell_seconds", "tiny/door"), dwell_at_most, 2);
}

TEST_F(Counts, StoriesBegunAndHeardToTheEnd) {
  const size_t visitor = join(32, 32);
  tells(visitor, show->stage.exhibit.stories[0].id);
  const std::string key = "tiny/" + show->stage.exhibit.stories[0].id;
  EXPECT_EQ(sum("stories_begun", key), 1);
  say(R"({"type":"storyteller","action":"stop"})", visitor);
  go(1);
  EXPECT_EQ(sum("stories_heard", key), 0) << "broken off";
  tells(visitor, show->stage.exhibit.stories[0].id);
  for (int i = 0; i < 400; i++) step(0.5);
  EXPECT_EQ(sum("stories_begun", key), 2);
  EXPECT_EQ(sum("stories_heard", key), 1);
}

TEST_F(Counts, ToursEndOrAreLeft) {
  const size_t visitor = join(32, 32), leaver = join(32, 32);
  const std::string play = R"({"type":"tour","action":"play"})";
  say(play, visitor);
  go(1);
  EXPECT_EQ(sum("tours_begun", "tiny/round"), 1);
  say(R"({"type":"tour","action":"pause"})", visitor);
  go(0.5);
  say(play, visitor);
  go(0.5);
  EXPECT_EQ(sum("tours_begun", "tiny/round"), 1) << "it goes on";
  say(play, leaver);
  go(0.5);
  browsers[leaver].link->mark_closed();
  go(0.5);
  EXPECT_EQ(sum("tours_begun", "tiny/round"), 2);
  EXPECT_EQ(sum("tours_abandoned", "tiny/round"), 0) << "they may come back";
  for (int i = 0; i < 62; i++) step(1.0);
  EXPECT_EQ(sum("tours_abandoned", "tiny/round"), 1);
  for (int i = 0; i < 1500 && sum("tours_finished", "tiny/round") == 0; i++) step(0.2);
  EXPECT_EQ(sum("tours_finished", "tiny/round"), 1);
  EXPECT_EQ(sum("tours_abandoned", "tiny/round"), 1);
  say(play, visitor);
  go(0.5);
  say(R"({"type":"viewpoint","seq":9,"name":"corner"})", visitor);
  go(0.5);
  EXPECT_EQ(sum("tours_abandoned", "tiny/round"), 2);
}

TEST_F(Counts, WhoComesBackAfterABreakIsNoNewVisit) {
  const size_t visitor = join(32, 32);
  say(R"({"type":"tour","action":"play"})", visitor);
  go(3);
  const std::string token = last("keep", visitor)["token"];
  browsers[visitor].link->mark_closed();
  go(0.5);
  const size_t again = connect();
  say(json{{"type", "hello"}, {"width", 32}, {"height", 32}, {"resume", token}}.dump(), again);
  go(0.5);
  EXPECT_EQ(sum("visits", "tiny"), 1);
  EXPECT_EQ(sum("tours_begun", "tiny/round"), 1);
  for (int i = 0; i < 62; i++) step(1.0);
  EXPECT_EQ(sum("tours_abandoned", "tiny/round"), 0);
}

TEST_F(Counts, GuestsOfAKioskWhenTheyAreGreeted) {
  page("hall");
  const size_t eye = camera("hall");
  go(1);
  EXPECT_EQ(of("kiosk_visits"), 0u);
  see(eye, {near_screen});
  go(6);
  EXPECT_EQ(sum("kiosk_visits", "tiny/hall"), 1);
  EXPECT_EQ(of("visits"), 0u);
  EXPECT_EQ(of("dwell_seconds"), 0u) << "a screen stands there all day";
}

}  // namespace
}  // namespace wellspring::test
