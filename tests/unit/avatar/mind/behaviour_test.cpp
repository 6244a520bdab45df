// SPDX-License-Identifier: Apache-2.0
// The mood machine against a clock of our own.
#include <gtest/gtest.h>

#include "avatar/mind/gaze.h"

namespace wellspring::test {
namespace {

struct Play {
  BehaviourState state;
  StorytellerInput input;
  double now = 0;
  int greeted = 0, farewelled = 0, changes = 0;
  uint32_t guest = 0;
  double greeted_at = -1, farewelled_at = -1;

  void tick(double dt) {
    now += dt;
    StorytellerEvents events;
    Mood before = state.mood;
    decide(state, input, now, events);
    changes += before != state.mood;
    if (events.greeted) greeted++, greeted_at = now, guest = events.guest;
    if (events.farewelled) farewelled++, farewelled_at = now, guest = events.guest;
  }
  void run(double seconds, double dt = 0.05) {
    for (double end = now + seconds; now < end - 1e-9;) tick(std::min(dt, end - now));
  }
  void present(std::vector<uint32_t> ids, float x = 0) {
    input.guests.clear();
    for (size_t i = 0; i < ids.size(); i++)
      input.guests.push_back({ids[i], {x + float(i), 1.6f, 1.2f}, vec3(0), true});
  }
};

TEST(Behaviour, AKioskSaysWhoStaysAndWhoLeaves) {
  Play play;
  play.input.staying = true;
  play.present({7});
  play.run(5);
  EXPECT_EQ(play.greeted, 1);
  play.input.met = true;
  play.present({});
  play.run(60);
  EXPECT_EQ(play.farewelled, 0) << "unseen, and there";
  EXPECT_EQ(play.state.mood, Mood::attending);
  play.input.staying = false;
  play.input.parting = true;
  play.tick(0.05);
  play.input.parting = false;
  EXPECT_EQ(play.farewelled, 1);
  EXPECT_EQ(play.state.mood, Mood::farewell);
  play.run(1);
  EXPECT_EQ(play.state.mood, Mood::farewell);
  play.input.staying = true;
  play.present({8}, 2);
  play.run(1);
  EXPECT_EQ(play.state.mood, Mood::attending) << "back: nothing more of goodbye";
  EXPECT_EQ(play.greeted, 1) << "met before";
  EXPECT_EQ(play.farewelled, 1);
}

TEST(Behaviour, WhoStandsWhereAGuestOfAnotherVisitStoodIsGreeted) {
  Play play;
  play.present({7});
  play.run(2);
  EXPECT_EQ(play.greeted, 1);
  play.present({});  // the kiosk is switched off: nobody has seen them leave
  play.run(1);
  play.input.visit++;
  play.present({7});
  play.run(2);
  EXPECT_EQ(play.greeted, 2);
  play.run(60);
  EXPECT_EQ(play.greeted, 2);
  EXPECT_EQ(play.farewelled, 0);
}

TEST(Behaviour, AWholeVisit) {
  Play play;
  play.run(5);
  EXPECT_EQ(play.state.mood, Mood::idle);
  play.input.kiosk_motion = true;
  play.tick(0.05);
  EXPECT_EQ(play.state.mood, Mood::noticing);
  play.run(1);
  play.input.kiosk_motion = false;
  double appears = play.now;
  play.present({7});
  play.run(0.2);
  EXPECT_EQ(play.greeted, 0);
  play.run(0.5);
  EXPECT_EQ(play.greeted, 1);
  EXPECT_EQ(play.guest, 7u);
  EXPECT_LE(play.greeted_at - appears, 0.7);
  EXPECT_EQ(play.state.mood, Mood::greeting);
  play.run(3);
  EXPECT_EQ(play.state.mood, Mood::attending);
  play.run(600);
  EXPECT_EQ(play.state.mood, Mood::attending);
  EXPECT_EQ(play.greeted, 1);
  double leaves = play.now;
  play.present({});
  play.run(1.9);
  EXPECT_EQ(play.state.mood, Mood::attending);
  play.run(0.3);
  EXPECT_EQ(play.state.mood, Mood::farewell);
  EXPECT_EQ(play.farewelled, 1);
  EXPECT_EQ(play.guest, 7u);
  EXPECT_NEAR(play.farewelled_at - leaves, 2, 0.15);
  play.run(3.1);
  EXPECT_EQ(play.state.mood, Mood::idle);
  play.run(60);
  EXPECT_EQ(play.farewelled, 1);
  EXPECT_EQ(play.greeted, 1);
}

TEST(Behaviour, MotionAloneIsNoticedAndForgotten) {
  Play play;
  play.input.kiosk_motion = true;
  play.run(10);
  EXPECT_EQ(play.state.mood, Mood::noticing);
  EXPECT_EQ(play.changes, 1);
  play.input.kiosk_motion = false;
  play.run(2.3);
  EXPECT_EQ(play.state.mood, Mood::noticing);
  play.run(0.5);
  EXPECT_EQ(play.state.mood, Mood::idle);
  EXPECT_EQ(play.greeted + play.farewelled, 0);
}

TEST(Behaviour, FlickeringDetectionNeitherGreetsTwiceNorSaysGoodbye) {
  Play play;
  for (int i = 0; i < 3000; i++) {  // ten times a second there, then not
    play.present(i % 2 ? std::vector<uint32_t>{uint32_t(3)} : std::vector<uint32_t>{});
    play.tick(0.05);
  }
  EXPECT_EQ(play.greeted, 1);
  EXPECT_EQ(play.farewelled, 0);
  EXPECT_EQ(play.state.mood, Mood::attending);
  EXPECT_LE(play.changes, 3);
}

TEST(Behaviour, SingleFlashesAreNobody) {
  Play play;
  for (int i = 0; i < 50; i++) {
    play.present({uint32_t(i)});
    play.tick(0.05);
    play.present({});
    play.run(3);
  }
  EXPECT_EQ(play.greeted, 0);
  EXPECT_EQ(play.farewelled, 0);
}

TEST(Behaviour, ANewNumberAtTheSamePlaceIsTheSamePerson) {
  Play play;
  play.present({1});
  play.run(5);
  for (uint32_t id = 2; id < 30; id++) {
    play.present({});
    play.run(0.7);
    play.present({id}, 0.2f);
    play.run(3);
  }
  EXPECT_EQ(play.greeted, 1);
  EXPECT_EQ(play.farewelled, 0);
}

TEST(Behaviour, SomebodyElseWhoJoinsIsGreetedToo) {
  Play play;
  play.present({1});
  play.run(6);
  double joins = play.now;
  play.present({1, 2});
  play.run(0.7);
  EXPECT_EQ(play.greeted, 2);
  EXPECT_EQ(play.guest, 2u);
  EXPECT_LE(play.greeted_at - joins, 0.7);
  play.present({2}, 1);
  play.run(10);
  EXPECT_EQ(play.farewelled, 0) << "one of them is still there";
  play.present({});
  play.run(3);
  EXPECT_EQ(play.farewelled, 1);
}

TEST(Behaviour, AGroupIsGreetedOnce) {
  Play play;
  play.present({1, 2, 3});
  play.run(30);
  EXPECT_EQ(play.greeted, 1);
}

TEST(Behaviour, AfterAFarewellTheNextVisitorIsGreeted) {
  Play play;
  for (uint32_t visitor = 1; visitor <= 5; visitor++) {
    play.present({visitor});
    play.run(8);
    play.present({});
    play.run(8);
    EXPECT_EQ(play.greeted, int(visitor));
    EXPECT_EQ(play.farewelled, int(visitor));
    EXPECT_EQ(play.state.mood, Mood::idle);
  }
}

TEST(Behaviour, AStoryIsTelledBetweenGreetingAndFarewell) {
  Play play;
  play.input.telling = true;
  play.run(1);
  EXPECT_EQ(play.state.mood, Mood::telling);
  play.present({4});
  play.run(0.6);
  EXPECT_EQ(play.state.mood, Mood::greeting);
  play.run(3);
  EXPECT_EQ(play.state.mood, Mood::telling);
  play.present({});
  play.run(2.5);
  EXPECT_EQ(play.state.mood, Mood::farewell);
  play.run(3);
  EXPECT_EQ(play.state.mood, Mood::telling);
}

TEST(Behaviour, RemoteVisitorsAreNotGreeted) {
  Play play;
  play.input.guests = {{1, {0, 1.6f, 1}, vec3(0), false}};
  play.run(20);
  EXPECT_EQ(play.greeted, 0);
  EXPECT_EQ(play.state.mood, Mood::idle);
}

TEST(Behaviour, HoursBetweenTicksAndImpossibleGuests) {
  Play play;
  play.present({1});
  play.tick(0.1);
  play.tick(3600);
  EXPECT_EQ(play.greeted, 1);
  play.present({});
  play.tick(3600);
  EXPECT_EQ(play.farewelled, 1);
  play.tick(3600);
  EXPECT_EQ(play.state.mood, Mood::idle);
  play.input.guests = {{9, {NAN, 0, 0}, vec3(0), true}};
  play.run(5);
  EXPECT_EQ(play.greeted, 1);
  EXPECT_TRUE(play.state.people.empty());
}

TEST(Behaviour, ManyPeopleDoNotGrowMemory) {
  Play play;
  for (uint32_t i = 0; i < 500; i++) {
    play.present({});
    for (uint32_t k = 0; k < 50; k++)
      play.input.guests.push_back({i * 100 + k, {float(k), 0, 0}, vec3(0), true});
    play.tick(0.05);
  }
  EXPECT_LE(play.state.people.size(), 32u);
}

}  // namespace
}  // namespace wellspring::test
