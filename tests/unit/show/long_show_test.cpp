// SPDX-License-Identifier: Apache-2.0
// A day in the museum on an accelerated clock, and two visitors at once.
#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <malloc.h>

#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "unit/show/kiosk_house.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct House : ShowStage {
  explicit House(int visitors) {
    begin(make_tiny_exhibit(), settings_for("direct", 50));
    for (int i = 0; i < visitors; i++) join(48, 32);
  }
};

TEST(LongShow, ADayOfIdlingAndWalkingNeitherGrowsNorDrifts) {
  House house(1);
  size_t memory = 0;
  constexpr double step = 120, day = 24 * 3600;
  constexpr int warm = 6 * 31;  // lists have by then held the most that they ever will
  for (int i = 0; i * step < day; i++) {
    // Most of an hour of rest, a quarter of walking and looking round, a jump.
    int phase = i % 31;
    if (phase == 20 || phase == 25)
      house.say(R"({"type":"input","seq":)" + std::to_string(++house.seq) +
                R"(,"move":[0.3,0,1],"look":[0.7,0.05]})");
    if (phase == 29)
      house.say(R"({"type":"input","seq":)" + std::to_string(++house.seq) +
                R"(,"move":[0,0,0],"look":[0,-0.1]})");
    if (phase == 30)
      house.say(R"({"type":"viewpoint","seq":)" + std::to_string(++house.seq) +
                R"(,"name":"corner"})");
    house.step(step);
    house.step();
    const Visitor& visitor = house.show->visits.visitors.front();
    vec3 place(visitor.place.view.position);
    ASSERT_TRUE(is_finite(place) && std::abs(place.x) < 4 && std::abs(place.z) < 4) << i;
    for (vec3 c : house.show->drawing->renderer.work.frame.color) ASSERT_TRUE(is_finite(c)) << i;
    if (i > warm / 2 && i <= warm) memory = std::max(memory, visitor.picture->cache_bytes);
    if (i > warm) {
      // Lists keep room for the most that they ever held, and how much that is depends on the
      // machine.
      ASSERT_LE(visitor.picture->cache_bytes, memory + memory / 8) << i;
      ASSERT_LE(visitor.picture->memory_bytes, memory + (1 << 19)) << i;
      ASSERT_LE(visitor.place.heading.past.size(), 64u);
      ASSERT_LE(visitor.shown.flow.in_flight.size(), 4024u);
    }
  }
  EXPECT_GT(house.pictures(0).size(), 600u);
  EXPECT_EQ(house.last_image().width, 48);
}

TEST(LongShow, TwoVisitorsGetPicturesAndSamplesAlike) {
  House house(2);
  // Whoever has come is a visitor after the first step.
  house.step();
  const Visitor &one = house.show->visits.visitors.front(),
                &other = house.show->visits.visitors.back();
  const auto asked_by = [](const Visitor& visitor) {
    return double(visitor.picture->broker.stats().asked);
  };
  // A busy machine traces few samples a picture: it takes longer until shares tell anything.
  constexpr double enough = 20000;
  for (int i = 0; i < 100 || (i < 5000 && asked_by(one) + asked_by(other) < enough); i++) {
    if (i % 10 == 0)
      for (size_t visitor : {0, 1}) house.turn(0.02, 0.2, visitor);
    house.step();
  }
  const auto pictures = [&](size_t visitor) { return double(house.pictures(visitor).size()); };
  EXPECT_NEAR(pictures(0), pictures(1), 2 + 0.1 * pictures(0));
  ASSERT_GE(asked_by(one) + asked_by(other), enough);
  EXPECT_NEAR(asked_by(one) / (asked_by(one) + asked_by(other)), 0.5, 0.2);
}

// A kiosk's day: every hour somebody comes, is told a story, and goes.
struct KioskDay : KioskHouse {
  void SetUp() override {
    KioskSettings hall;
    hall.name = "hall";
    hall.times.hold_person = hall.times.leave_after = 1;
    hall.times.farewell = hall.times.sleep_after = hall.times.sleep_latest = 2;
    set_up({hall});
  }
};

TEST_F(KioskDay, LeavesNothingBehind) {
  const size_t hall = page("hall"), eye = camera("hall");
  size_t early = 0;
  for (int visit = 0; visit < 24; visit++) {
    see(eye, {near_screen + vec3(0.01f * float(visit % 7), 0, 0)});
    go(2);
    ASSERT_TRUE(has_guest(show->kiosks.all[0].stage.now)) << visit;
    does(hall, "story");
    tells(hall, visit % 2 ? "other" : "tale");
    go(2);
    see(eye, {});
    does(hall, "well", false);
    for (int i = 0; i < 30 && show->kiosks.all[0].stage.now != Stage::sleep; i++) go(1);
    ASSERT_EQ(show->kiosks.all[0].stage.now, Stage::sleep) << visit;
    step(3590.0);
    go(1);
    EXPECT_TRUE(show->kiosks.all[0].visit.heard.empty());
    EXPECT_TRUE(show->cast.teller.voice.queue.empty());
    EXPECT_TRUE(show->cast.teller.mind.behaviour.people.empty());
    EXPECT_TRUE(show->kiosks.all[0].audience.known.empty());
    cameras[eye].orders.clear();
    for (Browser& browser : browsers) {
      browser.texts.clear(), browser.pictures.clear(), browser.sounds.clear();
      browser.texts.shrink_to_fit(), browser.pictures.shrink_to_fit();
    }
    const size_t used = mallinfo2().uordblks;
    if (visit == 6) early = used;
    if (visit > 6) ASSERT_LT(used, early + (1 << 20)) << "visit " << visit;
  }
  EXPECT_EQ(show->totals.greetings, 24u);
  EXPECT_EQ(show->totals.farewells, 24u);
  EXPECT_EQ(show->kiosks.all.size(), 1u);
}

}  // namespace
}  // namespace wellspring::test
