// SPDX-License-Identifier: Apache-2.0
// Kiosks of one house: stages, pages and cameras by name, and the storyteller who is with one.
#include <gtest/gtest.h>

#include "show/answer/groups.h"
#include "show/kiosk/kiosk.h"
#include "unit/show/kiosk_house.h"

namespace wellspring::test {
namespace {

using Kiosks = KioskHouse;

TEST_F(Kiosks, EachHasItsOwnStageAndPeople) {
  const size_t hall = page("hall"), attic = page("attic"), visitor = join(32, 32);
  const size_t in_hall = camera("hall"), in_attic = camera("attic");
  see(in_hall, {near_screen, {0.8f, 0, 2}});
  go(1);
  EXPECT_EQ(stage(hall), "person");
  EXPECT_EQ(heard(hall)["kiosk"], "hall");
  EXPECT_EQ(heard(hall)["people"], 2);
  EXPECT_EQ(heard(hall)["cameras"], 1);
  EXPECT_EQ(heard(hall)["distance"], 1);
  EXPECT_EQ(stage(attic), "sleep");
  EXPECT_EQ(heard(attic)["people"], 0);
  see(in_attic, {{0, 0, 0.7f}});
  go(1);
  EXPECT_EQ(stage(attic), "person");
  const json sum = heard(visitor);
  EXPECT_EQ(sum["people"], 3) << "visitors hear of all";
  EXPECT_EQ(sum["cameras"], 2);
  EXPECT_NEAR(sum["distance"].get<double>(), 0.7, 1e-6);
  EXPECT_FALSE(sum.contains("stage"));
}

TEST_F(Kiosks, OneCameraLessSilencesNoOtherKiosk) {
  const size_t hall = page("hall"), attic = page("attic");
  const size_t in_hall = camera("hall"), in_attic = camera("attic");
  see(in_hall, {near_screen});
  see(in_attic, {near_screen});
  go(1);
  const uint64_t guest = find_kiosk(show->kiosks, "attic")->audience.guests.at(0).id;
  cameras[in_hall].on = false;
  cameras[in_hall].link->mark_closed();
  go(3);
  EXPECT_EQ(stage(attic), "person");
  EXPECT_EQ(find_kiosk(show->kiosks, "attic")->audience.guests.at(0).id, guest)
      << "the same as before";
  EXPECT_EQ(heard(hall)["cameras"], 0);
  camera("hall");
  see(2, {near_screen});
  go(1);
  EXPECT_NE(find_kiosk(show->kiosks, "hall")->audience.guests.at(0).id, guest);
}

TEST_F(Kiosks, AScreenOfKnownSizeIsSeenThroughFromTheGuestsHead) {
  KioskSettings hall_settings, attic_settings;
  hall_settings.name = "hall", hall_settings.screen = {0.6f, 0.6f};
  attic_settings.name = "attic";
  set_up({hall_settings, attic_settings});
  const size_t hall = page("hall"), attic = page("attic");
  const size_t in_hall = camera("hall"), in_attic = camera("attic");
  auto seen = [&](size_t number) {
    return std::next(show->visits.visitors.begin(), long(number))->place.last_view;
  };
  const View rest = seen(hall), other = seen(attic);
  const float away = rest_distance(hall_settings.screen, rest);
  const vec3 head(0.05f, 0.03f, 1.1f * away);
  see(in_hall, {head});
  see(in_attic, {head});
  go(4);
  EXPECT_EQ(seen(attic), other) << "its size is not known";
  const View view = seen(hall);
  EXPECT_NE(view.middle, vec2(0));
  // The storyteller looks at the guest's head: from there the picture is seen.
  const vec3 guest = find_kiosk(show->kiosks, "hall")->audience.guests.at(0).head;
  EXPECT_LT(glm::length(guest - view.position), 1e-3f);
  for (vec2 corner : {vec2(-0.3f, 0.3f), vec2(0.3f, 0.3f), vec2(0.3f, -0.3f)}) {
    const vec3 place =
        rest.position + away * rest.forward + corner.x * rest.right + corner.y * rest.up;
    const Projected at = project_point(view, place);
    EXPECT_NEAR(at.x, 16 + 16 * corner.x / 0.3f, 0.01f);
    EXPECT_NEAR(at.y, 16 - 16 * corner.y / 0.3f, 0.01f);
  }
  does(hall, "book");  // hides the picture
  go(4);
  EXPECT_EQ(seen(hall), rest);
  does(hall, "well");
  go(4);
  EXPECT_EQ(seen(hall).middle, view.middle);
  say(R"({"type":"input","seq":1,"move":[0,0,1]})", hall);
  go(4);
  EXPECT_EQ(seen(hall).middle, vec2(0)) << "who walks is no longer at the window";
}

TEST_F(Kiosks, SheIsWithTheFirstUntilItsFarewellIsOver) {
  const size_t hall = page("hall"), attic = page("attic"), visitor = join(32, 32);
  const size_t in_hall = camera("hall"), in_attic = camera("attic");
  EXPECT_EQ(heard(hall)["storyteller"], "none");
  see(in_hall, {near_screen});
  go(1);
  see(in_attic, {near_screen});
  go(3);
  EXPECT_EQ(heard(hall)["storyteller"], "here");
  EXPECT_EQ(heard(attic)["storyteller"], "elsewhere");
  EXPECT_EQ(read(hall), std::vector<std::string>{"Welcome."});
  EXPECT_EQ(read(visitor), std::vector<std::string>{"Welcome."});
  EXPECT_TRUE(read(attic).empty());
  tells(attic, "tale");
  EXPECT_EQ(last("error", attic)["code"], "storyteller_busy");
  EXPECT_EQ(show->cast.teller.voice.story, "");
  see(in_hall, {});
  go(3);
  EXPECT_EQ(stage(hall), "farewell");
  EXPECT_EQ(heard(attic)["storyteller"], "elsewhere");
  EXPECT_EQ(read(hall).back(), "Goodbye.");
  go(6.5);
  EXPECT_EQ(heard(attic)["storyteller"], "here");
  EXPECT_EQ(heard(hall)["storyteller"], "elsewhere");
  go(2);
  EXPECT_EQ(read(attic), std::vector<std::string>{"Hello."}) << "now its turn has come";
  tells(attic, "tale");
  EXPECT_EQ(show->cast.teller.voice.story, "tale");
  EXPECT_EQ(show->totals.greetings, 2u);
  EXPECT_EQ(show->totals.farewells, 1u);
}

TEST_F(Kiosks, AFarewellStopsWhatTheGuestBegan) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen});
  go(1);
  tells(hall, "tale");
  EXPECT_EQ(stage(hall), "engaged");
  see(in_hall, {});
  go(5);
  EXPECT_EQ(show->cast.teller.voice.story, "tale") << "who looks away is told on";
  EXPECT_EQ(stage(hall), "engaged");
  go(2);
  EXPECT_EQ(stage(hall), "farewell");
  EXPECT_EQ(show->cast.teller.voice.story, "");
  EXPECT_EQ(read(hall).back(), "Goodbye.");
  EXPECT_EQ(show->totals.farewells, 1u);
  go(30);
  EXPECT_EQ(stage(hall), "sleep");
  EXPECT_EQ(show->totals.farewells, 1u);
}

TEST_F(Kiosks, AFarewellStopsTheTourAndTheScreenIsAWindowAgain) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen});
  go(1);
  say(R"({"type":"tour","action":"play"})", hall);
  go(3);
  EXPECT_EQ(stage(hall), "engaged");
  see(in_hall, {});
  go(7);
  ASSERT_EQ(stage(hall), "farewell");
  EXPECT_EQ(show->visits.visitors.front().place.tour.state, TourRide::State::none);
  EXPECT_EQ(show->visits.visitors.front().place.viewpoint,
            kiosk_viewpoint(show->stage, show->cast, "hall"));
}

TEST_F(Kiosks, WhoComesBackIsNotGreetedAgain) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen});
  go(3);
  see(in_hall, {});
  go(3);
  ASSERT_EQ(stage(hall), "farewell");
  see(in_hall, {near_screen});
  go(8);
  EXPECT_EQ(stage(hall), "person");
  EXPECT_EQ(show->totals.greetings, 1u);
  EXPECT_NE(last("agent", hall)["mood"], "farewell");
}

TEST_F(Kiosks, OfTwoOneLeavesAndTheOtherIsToldOn) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen, {0.8f, 0, 1.5f}});
  go(1);
  tells(hall, "tale");
  see(in_hall, {near_screen});
  go(20);
  EXPECT_EQ(stage(hall), "engaged");
  EXPECT_EQ(show->cast.teller.voice.story, "tale");
  EXPECT_EQ(show->totals.farewells, 0u);
}

TEST_F(Kiosks, WithoutACameraATouchBringsHer) {
  const size_t hall = page("hall");
  EXPECT_EQ(stage(hall), "sleep");
  does(hall, "well");
  EXPECT_EQ(stage(hall), "person");
  go(1);
  EXPECT_EQ(read(hall), std::vector<std::string>{"Welcome."});
  does(hall, "book");
  EXPECT_EQ(stage(hall), "engaged");
  go(44);
  EXPECT_EQ(stage(hall), "engaged");
  go(2);
  EXPECT_EQ(stage(hall), "farewell");
  EXPECT_EQ(read(hall).back(), "Goodbye.");
  go(7);
  EXPECT_EQ(stage(hall), "sleep") << "though the page still shows the book";
}

TEST_F(Kiosks, ADarkCameraIsNone) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  cameras[in_hall].seen.camera = CameraState::dark;
  go(1);
  does(hall, "well");
  does(hall, "well");
  EXPECT_EQ(stage(hall), "engaged");
}

TEST_F(Kiosks, OnlyAKiosksPageSpeaksForAKiosk) {
  join(32, 32);
  does(0, "book");
  EXPECT_EQ(last("error")["code"], "no_kiosk");
}

TEST_F(Kiosks, SheRemembersWhatAGuestHasHeardAndForgetsItWithThem) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen});
  go(1);
  tells(hall, "tale");
  EXPECT_EQ(heard(hall)["heard"], json({"tale"}));
  say(R"({"type":"storyteller","action":"stop"})", hall);
  see(in_hall, {near_screen}, "swipe_left");
  go(0.3);
  EXPECT_EQ(show->cast.teller.voice.story, "other") << "the one that is new to them";
  EXPECT_EQ(heard(hall)["heard"], json({"tale", "other"}));
  EXPECT_FALSE(find_kiosk(show->kiosks, "hall")->visit == KioskVisit{});
  see(in_hall, {});
  go(30);
  EXPECT_EQ(heard(hall)["heard"], json::array());
  const Kiosk& kiosk = *find_kiosk(show->kiosks, "hall");
  EXPECT_EQ(kiosk.visit, KioskVisit{});
  EXPECT_TRUE(kiosk.gestures.empty());
  EXPECT_TRUE(kiosk.audience.guests.empty());
  EXPECT_TRUE(kiosk.audience.known.empty());
  EXPECT_TRUE(show->cast.teller.mind.behaviour.people.empty());
  see(in_hall, {near_screen});
  go(1);
  EXPECT_EQ(show->totals.greetings, 2u) << "somebody new";
}

TEST_F(Kiosks, GesturesTurnThePagesOfABook) {
  const size_t hall = page("hall"), in_hall = camera("hall");
  see(in_hall, {near_screen});
  go(1);
  does(hall, "book");
  EXPECT_FALSE(heard(hall).contains("gesture"));
  for (int number : {1, 2}) {
    see(in_hall, {near_screen}, "swipe_left");
    go(0.4);
    EXPECT_EQ(heard(hall)["gesture"], json({{"name", "swipe_left"}, {"number", number}}));
    see(in_hall, {near_screen});
    go(0.4);
  }
  EXPECT_EQ(show->cast.teller.voice.story, "");
  does(hall, "museum");
  EXPECT_FALSE(heard(hall).contains("gesture"));
  see(in_hall, {near_screen}, "swipe_left");
  go(0.4);
  EXPECT_EQ(show->cast.teller.voice.story, "tale");
}

TEST_F(Kiosks, CamerasAreToldWhatIsNeeded) {
  const size_t in_hall = camera("hall");
  auto order = [&] { return cameras[in_hall].orders.back(); };
  auto needs = [](bool faces, bool expression, bool gestures) {
    return json{{"faces", faces}, {"expression", expression}, {"gestures", gestures}};
  };
  EXPECT_EQ(order()["stage"], "sleep");
  EXPECT_EQ(order()["needs"], needs(false, false, false));
  see(in_hall, {near_screen});
  go(0.1);
  EXPECT_EQ(order()["needs"], needs(true, false, false)) << "no screen follows gestures";
  const size_t hall = page("hall");
  go(1);
  EXPECT_EQ(order()["stage"], "person");
  EXPECT_EQ(order()["needs"], needs(true, true, true)) << "greeted";
  does(hall, "book");
  EXPECT_EQ(order()["stage"], "engaged");
  const size_t orders = cameras[in_hall].orders.size();
  go(3);
  EXPECT_EQ(cameras[in_hall].orders.size(), orders) << "news alone";
  const size_t in_attic = camera("attic");
  see(in_attic, {near_screen});
  page("attic");
  go(1);
  EXPECT_EQ(cameras[in_attic].orders.back()["needs"], needs(true, false, true))
      << "she looks at nobody there";
  see(in_hall, {});
  go(7);
  EXPECT_EQ(order()["needs"], needs(true, false, false));
}

TEST_F(Kiosks, WithoutANameOneBelongsToTheOnlyOne) {
  camera("");
  const size_t hall = page("hall");
  see(0, {near_screen});
  go(1);
  EXPECT_EQ(stage(hall), "person");
  page("attic");
  go(3);
  EXPECT_EQ(heard(hall)["cameras"], 0) << "there are two: whose it is is not known";
}

TEST_F(Kiosks, OfNoExhibitLiveAsLongAsSomebodyIsConnected) {
  page("hall");
  camera("attic");
  EXPECT_EQ(show->kiosks.all.size(), 2u);
  cameras[0].on = false;
  cameras[0].link->mark_closed();
  browsers[0].link->mark_closed();
  go(0.3);
  EXPECT_TRUE(show->kiosks.all.empty());
}

TEST_F(Kiosks, AreAsTheExhibitSays) {
  KioskSettings settings{.name = "hall", .viewpoint = "corner", .volume = 0.4f};
  settings.times.leave_untouched = 5;
  set_up({settings});
  const size_t hall = page("");
  EXPECT_EQ(heard(hall)["kiosk"], "hall");
  EXPECT_NEAR(heard(hall)["volume"].get<double>(), 0.4, 1e-6);
  EXPECT_EQ(show->visits.visitors.front().place.viewpoint, 1);
  does(hall, "well");
  go(4.5);
  EXPECT_EQ(stage(hall), "person");
  go(1);
  EXPECT_EQ(stage(hall), "farewell");
}

}  // namespace
}  // namespace wellspring::test
