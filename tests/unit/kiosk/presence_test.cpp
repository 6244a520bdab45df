// SPDX-License-Identifier: Apache-2.0
#include "kiosk/observe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace wellspring::test {
namespace {

struct Change {
  double time;
  Presence to;
};

// Runs the machine at `rate` from `begin` to `end`; returns the changes of state.
struct Script {
  PresenceState state;
  PresenceSettings settings;
  double rate = 20;
  std::vector<Change> changes;
  long frame = 0;

  void play(double seconds, const std::function<bool(double)>& moving,
            const std::function<bool(double)>& face) {
    const double begin = double(frame) / rate;
    for (const long end = frame + std::lround(seconds * rate); frame < end; frame++) {
      double time = double(frame) / rate;
      Presence before = state.now;
      Presence now = step_presence(state, settings, time, moving(time - begin),
                                   face(time - begin) ? FacesSeen::visitor : FacesSeen::none);
      if (now != before) changes.push_back({time, now});
    }
  }
  void run(double seconds, bool moving, bool face) {
    play(
        seconds, [=](double) { return moving; }, [=](double) { return face; });
  }
};

TEST(Presence, starts_absent_and_stays_so_in_an_empty_room) {
  Script s;
  s.run(60, false, false);
  EXPECT_TRUE(s.changes.empty());
  EXPECT_EQ(s.state.now, Presence::absent);
}

TEST(Presence, movement_wakes_after_its_time_and_not_before) {
  Script s;
  s.run(1, false, false);
  s.run(2, true, false);
  ASSERT_EQ(s.changes.size(), 1u);
  EXPECT_EQ(s.changes[0].to, Presence::motion);
  EXPECT_NEAR(s.changes[0].time, 1 + s.settings.wake_after, 1 / s.rate + 1e-9);
  EXPECT_GE(s.changes[0].time, 0.95 + s.settings.wake_after - 1e-9);
}

TEST(Presence, a_short_movement_does_not_wake) {
  Script s;
  s.run(1, false, false);
  s.run(s.settings.wake_after - 0.1, true, false);
  s.run(5, false, false);
  EXPECT_TRUE(s.changes.empty());
}

TEST(Presence, motion_falls_asleep_after_its_hold) {
  Script s;
  s.run(1, true, false);
  s.run(10, false, false);
  ASSERT_EQ(s.changes.size(), 2u);
  EXPECT_EQ(s.changes[1].to, Presence::absent);
  EXPECT_NEAR(s.changes[1].time, 0.95 + s.settings.hold_motion, 2 / s.rate);
}

TEST(Presence, a_face_is_confirmed_from_absent_and_from_motion) {
  for (bool moving : {false, true}) {
    Script s;
    s.run(1, moving, false);
    s.run(2, moving, true);
    ASSERT_FALSE(s.changes.empty());
    EXPECT_EQ(s.changes.back().to, Presence::person);
    EXPECT_NEAR(s.changes.back().time, 1 + s.settings.confirm_after, 1 / s.rate + 1e-9);
    EXPECT_EQ(s.changes.size(), moving ? 2u : 1u);
  }
}

TEST(Presence, a_glimpse_of_a_face_is_no_person) {
  Script s;
  s.run(1, false, false);
  s.run(s.settings.confirm_after - 0.1, false, true);
  s.run(5, false, false);
  EXPECT_TRUE(s.changes.empty());
}

TEST(Presence, a_person_who_stays_but_turns_away_becomes_motion) {
  Script s;
  s.run(2, true, true);
  s.changes.clear();
  s.run(6, true, false);
  ASSERT_EQ(s.changes.size(), 1u);
  EXPECT_EQ(s.changes[0].to, Presence::motion);
  EXPECT_NEAR(s.changes[0].time, 1.95 + s.settings.hold_person, 2 / s.rate);
}

TEST(Presence, a_person_who_leaves_is_gone_within_both_holds) {
  Script s;
  s.run(2, true, true);
  s.changes.clear();
  s.run(10, false, false);
  ASSERT_EQ(s.changes.size(), 2u);
  EXPECT_EQ(s.changes[0].to, Presence::motion);
  EXPECT_EQ(s.changes[1].to, Presence::absent);
  EXPECT_NEAR(s.changes[1].time, 1.95 + s.settings.hold_motion, 2 / s.rate);
}

TEST(Presence, a_person_lost_for_less_than_the_hold_stays) {
  Script s;
  s.run(2, true, true);
  s.changes.clear();
  for (int i = 0; i < 10; i++) {
    s.run(s.settings.hold_person - 0.2, false, false);
    s.run(0.3, false, true);
  }
  EXPECT_TRUE(s.changes.empty());
  EXPECT_EQ(s.state.now, Presence::person);
}

TEST(Presence, ten_hertz_noise_never_wakes_nor_confirms) {
  Script s{.rate = 40};
  auto flicker = [](double t) { return std::fmod(t, 0.1) < 0.05 - 1e-9; };
  s.play(30, flicker, flicker);
  EXPECT_TRUE(s.changes.empty());
}

TEST(Presence, ten_hertz_noise_on_the_way_out_changes_nothing_twice) {
  Script s{.rate = 40};
  auto flicker = [](double t) { return std::fmod(t, 0.1) < 0.05 - 1e-9; };
  s.run(3, true, true);
  s.play(20, flicker, flicker);  // half of the time seen: still there
  EXPECT_EQ(s.state.now, Presence::person);
  EXPECT_LE(s.changes.size(), 2u);
  s.play(20, flicker, [](double) { return false; });
  EXPECT_EQ(s.state.now, Presence::motion);
  EXPECT_LE(s.changes.size(), 3u);
}

TEST(Presence, who_may_be_a_picture_is_nobody_and_who_turns_out_to_live_is_there_at_once) {
  PresenceState state;
  double time = 0;
  for (; time < 3; time += 0.1)
    EXPECT_EQ(step_presence(state, {}, time, false, FacesSeen::unsure), Presence::absent);
  EXPECT_EQ(step_presence(state, {}, time, false, FacesSeen::visitor), Presence::person);
}

TEST(Presence, one_late_frame_is_not_long_evidence) {
  PresenceState state;
  PresenceSettings settings;
  step_presence(state, settings, 0, false, FacesSeen::none);
  EXPECT_EQ(step_presence(state, settings, 5, true, FacesSeen::visitor), Presence::absent);
}

TEST(Presence, a_clock_set_back_neither_frees_nor_freezes) {
  Script s;
  s.run(5, true, true);
  ASSERT_EQ(s.state.now, Presence::person);
  s.frame = 0;  // the file starts again, empty
  s.changes.clear();
  s.run(6, false, false);
  ASSERT_EQ(s.changes.size(), 2u);
  EXPECT_NEAR(s.changes[0].time, s.settings.hold_person, 2 / s.rate);
  EXPECT_EQ(s.state.now, Presence::absent);
}

TEST(Presence, a_time_that_is_no_number_changes_nothing) {
  PresenceState state;
  step_presence(state, {}, 1, true, FacesSeen::visitor);
  EXPECT_EQ(
      step_presence(state, {}, std::numeric_limits<double>::quiet_NaN(), true, FacesSeen::visitor),
      Presence::absent);
  EXPECT_EQ(state.last_time, 1);
}

}  // namespace
}  // namespace wellspring::test
