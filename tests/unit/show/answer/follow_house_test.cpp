// SPDX-License-Identifier: Apache-2.0
// A house that opens and closes, has quiet hours and says something on all screens.
#include "show/answer/idle.h"

#include "show/http/report.h"
#include "show/draw/pace.h"
#include "unit/show/kiosk_house.h"

namespace wellspring::test {
namespace {

struct FollowHouse : KioskHouse {
  void SetUp() override {
    set_up({});
    HouseSettings& house = show->settings.house;
    house.always_open = false;
    house.open.fill(MinuteSpan{9 * 60, 17 * 60});
    house.quiet = {{12 * 60, 13 * 60}};
    house.volume = 0.8f;
    house.quiet_volume = 0.2f;
    house.headphones = true;
    house.reload = 4 * 60;
    set_clock(10);
  }
  void set_clock(int hour, int minute = 0, int64_t day = 20000) {
    show->house.local_time = {day, hour * 60 + minute};
  }
  size_t reloads(size_t page) {
    size_t count = 0;
    for (const json& house : told("house", page)) count += house["reload"] == true;
    return count;
  }
  uint32_t announce(LocalText text, double seconds = 60, bool urgent = false) {
    Announcement announcement{.text = std::move(text), .seconds = seconds, .urgent = urgent};
    return arrivals.announce(announcement);
  }
};

TEST_F(FollowHouse, KiosksAreToldHowItIs) {
  const size_t hall = page("hall"), visitor = join(32, 32);
  go(1);
  EXPECT_EQ(told("house", hall).size(), 1u) << "news alone";
  const json day = {{"type", "house"},     {"open", true},  {"quiet", false},
                    {"headphones", false}, {"volume", 0.8}, {"reload", false},
                    {"take_along", false}};
  EXPECT_EQ(last("house", hall), day);
  EXPECT_EQ(heard(hall)["volume"], 0.8);
  set_clock(12);
  go(0.2);
  json noon = day;
  noon["quiet"] = noon["headphones"] = true;
  noon["volume"] = 0.2;
  EXPECT_EQ(last("house", hall), noon);
  EXPECT_EQ(heard(hall)["volume"], 0.2);
  EXPECT_TRUE(make_report(*show).quiet);
  EXPECT_EQ(last("house", page("attic")), noon) << "who comes later, too";
  set_clock(17);
  go(0.2);
  EXPECT_EQ(last("house", hall)["open"], false);
  EXPECT_EQ(last("house", hall)["quiet"], false);
  EXPECT_FALSE(make_report(*show).open);
  set_clock(9);
  go(0.2);
  EXPECT_EQ(last("house", hall), day);
  EXPECT_TRUE(told("house", visitor).empty()) << "at home it is always open";
}

TEST_F(FollowHouse, AtClosingAVisitIsBiddenFarewellAndTheEyeIdles) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen});
  go(2);
  tells(hall, "tale");
  ASSERT_EQ(stage(hall), "engaged");
  set_clock(17);
  go(0.3);
  EXPECT_EQ(stage(hall), "farewell");
  EXPECT_EQ(show->cast.teller.voice.story, "");
  EXPECT_EQ(heard(hall)["people"], 0);
  go(1);
  EXPECT_EQ(read(hall).back(), "Goodbye.");
  EXPECT_FALSE(cameras[in_hall].orders.back().contains("idle")) << "not yet";
  go(6);
  EXPECT_EQ(stage(hall), "sleep") << "whoever is there still";
  const json order = cameras[in_hall].orders.back();
  EXPECT_EQ(order["needs"], json({{"faces", false}, {"expression", false}, {"gestures", false}}));
  EXPECT_EQ(order["idle"], true);
  does(hall, "well");
  does(hall, "book");
  go(1);
  EXPECT_EQ(stage(hall), "sleep") << "touches wake nobody";
  EXPECT_EQ(show->totals.greetings, 1u);
  EXPECT_EQ(show->totals.farewells, 1u);
  does(hall, "well", false);
  set_clock(9);
  go(0.5);
  EXPECT_EQ(stage(hall), "person");
  EXPECT_FALSE(cameras[in_hall].orders.back().contains("idle"));
}

TEST_F(FollowHouse, WhoWasNotGreetedIsNotBiddenFarewell) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen});
  step_until([&] { return has_guest(find_kiosk(show->kiosks, "hall")->stage.now); });
  go(0.1);
  set_clock(17);
  go(0.3);
  EXPECT_EQ(stage(hall), "sleep");
  EXPECT_EQ(show->totals.farewells, 0u);
}

TEST_F(FollowHouse, ClosedKiosksGetPicturesNowAndThenVisitorsAsEver) {
  const size_t hall = page("hall"), home = join(32, 32);
  go(1);
  const Visitor &kiosk = show->visits.visitors.front(), &visitor = show->visits.visitors.back();
  ASSERT_TRUE(kiosk.kiosk && !visitor.kiosk);
  EXPECT_GT(picture_rate(*show, kiosk), 1);
  const double rate = picture_rate(*show, visitor), drawing = drawing_rate(*show, visitor);
  set_clock(17);
  go(1);
  EXPECT_EQ(picture_rate(*show, kiosk), 1);
  EXPECT_LE(drawing_rate(*show, kiosk), 1);
  EXPECT_EQ(picture_rate(*show, visitor), rate);
  EXPECT_EQ(drawing_rate(*show, visitor), drawing);
  for (Browser& browser : browsers) browser.acknowledges = true;
  go(1);
  const size_t before = pictures(hall).size(), at_home = pictures(home).size();
  go(10);
  EXPECT_LE(pictures(hall).size() - before, 15u);  // one a second, and what fades
  EXPECT_GT(pictures(home).size() - at_home, 30u);
}

TEST_F(FollowHouse, PagesAreLoadedAnewOnceANight) {
  set_clock(3);
  const size_t hall = page("hall"), home = join(32, 32);
  go(1);
  EXPECT_EQ(reloads(hall), 0u);
  set_clock(4);
  go(1);
  EXPECT_EQ(reloads(hall), 1u);
  set_clock(12);
  go(1);
  set_clock(3, 59, 20001);
  go(1);
  EXPECT_EQ(reloads(hall), 1u);
  const size_t again = page("hall");  // as it has loaded itself anew
  go(1);
  EXPECT_EQ(reloads(again), 0u) << "no circle";
  set_clock(4, 0, 20001);
  go(1);
  EXPECT_EQ(reloads(hall), 2u);
  EXPECT_EQ(reloads(again), 1u);
  EXPECT_EQ(reloads(home), 0u);
}

TEST_F(FollowHouse, NotWhileSomebodyIsThere) {
  show->settings.house.always_open = true;
  set_clock(3);
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen});
  go(1);
  does(hall, "book");
  set_clock(4);
  go(3);
  EXPECT_EQ(reloads(hall), 0u);
  see(in_hall, {});
  does(hall, "well", false);
  go(14);
  ASSERT_EQ(stage(hall), "sleep");
  EXPECT_EQ(reloads(hall), 1u) << "when they have left";
}

TEST_F(FollowHouse, AnnouncementsAreOnAllPagesAndOnThoseThatComeLater) {
  const size_t hall = page("hall"), home = join(32, 32);
  go(0.1);
  const uint32_t id = announce({{"en", "Hello."}, {"sk", "Ahoj."}}, 10, true);
  go(0.1);
  const json words = {{"en", "Hello."}, {"sk", "Ahoj."}};
  for (size_t page : {hall, home}) {
    const json said = last("announce", page);
    EXPECT_EQ(said["id"], id);
    EXPECT_EQ(said["text"], words);
    EXPECT_EQ(said["seconds"], 10);
    EXPECT_EQ(said["urgent"], true);
  }
  go(4);
  const size_t later = join(32, 32), kiosk = page("attic");
  for (size_t page : {later, kiosk}) {
    EXPECT_EQ(last("announce", page)["id"], id);
    EXPECT_NEAR(last("announce", page)["seconds"].get<double>(), 5.9, 0.3) << "what is left";
  }
  go(6);
  const size_t too_late = join(32, 32);
  go(0.1);
  EXPECT_TRUE(told("announce", too_late).empty());
  EXPECT_EQ(told("announce", hall).size(), 1u);
  EXPECT_EQ(show->totals.announcements, 1u);
}

TEST_F(FollowHouse, AnEmptyAnnouncementTakesTheLastBack) {
  const size_t hall = page("hall");
  const uint32_t first = announce({{"en", "Fire drill."}}, 600);
  go(0.1);
  const uint32_t second = announce({});
  EXPECT_GT(second, first);
  go(0.1);
  EXPECT_EQ(last("announce", hall)["text"], json::object());
  EXPECT_EQ(last("announce", hall)["id"], second);
  const size_t later = join(32, 32);
  go(0.1);
  EXPECT_TRUE(told("announce", later).empty());
}

}  // namespace
}  // namespace wellspring::test
