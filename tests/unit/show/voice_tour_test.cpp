// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "show/tour.h"
#include "show/voice.h"
#include "tiny_exhibit.h"

namespace wellspring {
namespace {

TEST(Voice, SaysAStorySentenceBySentence) {
  Voice voice;
  Exhibit exhibit = make_tiny_exhibit();
  tell(voice, exhibit.stories[0]);
  std::vector<std::string> said;
  int silences = 0;
  for (int i = 0; i < 1000; i++) {
    VoiceEvents events = advance_voice(voice, 0.01f);
    if (events.begun) said.push_back(events.begun->text.at("de"));
    silences += events.fell_silent;
  }
  EXPECT_EQ(said, (std::vector<std::string>{"Eins.", "Zwei."}));
  EXPECT_EQ(silences, 1);
  EXPECT_TRUE(voice.story.empty());
}

TEST(Voice, OverrideReplacesWhatIsBeingSaid) {
  Voice voice;
  tell(voice, make_tiny_exhibit().stories[0]);
  advance_voice(voice, 0.01f);
  say(voice, {{"en", "Goodbye"}}, true);
  VoiceEvents events = advance_voice(voice, 0.01f);
  ASSERT_TRUE(events.begun);
  EXPECT_EQ(events.begun->text.at("en"), "Goodbye");
  EXPECT_TRUE(voice.story.empty());
}

TEST(Voice, PauseHoldsAndTheMouthRests) {
  Voice voice;
  say(voice, {{"en", "A sentence of some length."}}, false);
  for (int i = 0; i < 50; i++) advance_voice(voice, 0.02f);
  EXPECT_GT(speaking(voice), 0.9f);
  voice.paused = true;
  float elapsed = voice.elapsed;
  advance_voice(voice, 100);
  EXPECT_EQ(voice.elapsed, elapsed);
  EXPECT_EQ(speaking(voice), 0);
}

TEST(Voice, LengthFollowsCharactersNotBytes) {
  EXPECT_FLOAT_EQ(speaking_seconds({{"sk", "čšž"}}), speaking_seconds({{"en", "csz"}}));
  EXPECT_GT(speaking_seconds({{"en", "a"}, {"de", "much longer"}}), speaking_seconds({{"en", "a"}}));
}

TEST(Voice, EmptyAndHugeSteps) {
  Voice voice;
  EXPECT_FALSE(advance_voice(voice, 1e9f).begun);
  say(voice, {}, true);
  EXPECT_TRUE(voice.queue.empty());
  EXPECT_EQ(nth_line({}, 3).size(), 0u);
  EXPECT_EQ(nth_line({{"en", {"a", "b"}}}, 3).at("en"), "b");
}

TEST(Tour, VisitsItsStopsAndEnds) {
  Exhibit exhibit = make_tiny_exhibit();
  TourRide ride;
  start_tour(ride, 0, exhibit.viewpoints[1].view);
  std::vector<int> arrivals;
  bool finished = false;
  Viewpoint last = exhibit.viewpoints[1].view;
  double fastest = 0;
  for (int i = 0; i < 2000 && !finished; i++) {
    TourStep step = advance_tour(ride, exhibit, 0.01f);
    if (step.arrived >= 0) arrivals.push_back(step.arrived);
    fastest = std::max(fastest, glm::length(step.view.position - last.position) / 0.01);
    last = step.view;
    finished = step.finished;
  }
  EXPECT_TRUE(finished);
  EXPECT_EQ(arrivals, (std::vector<int>{0, 1}));
  EXPECT_EQ(last.position, exhibit.viewpoints[1].view.position);
  // A quintic's greatest speed is 15/8 of the mean: no jump anywhere.
  EXPECT_LT(fastest, 1.01 * 15.0 / 8 * glm::length(exhibit.viewpoints[0].view.position - exhibit.viewpoints[1].view.position) / 2);
}

TEST(Tour, PauseHoldsThePlace) {
  Exhibit exhibit = make_tiny_exhibit();
  TourRide ride;
  start_tour(ride, 0, exhibit.viewpoints[1].view);
  for (int i = 0; i < 50; i++) advance_tour(ride, exhibit, 0.02f);
  ride.state = TourRide::State::paused;
  dvec3 here = advance_tour(ride, exhibit, 0.02f).view.position;
  EXPECT_EQ(advance_tour(ride, exhibit, 100).view.position, here);
}

TEST(Tour, YawTurnsTheShortWay) {
  Viewpoint a, b;
  a.yaw = 3;
  b.yaw = -3;
  float middle = blend_viewpoints(a, b, 0.5f).yaw;
  EXPECT_NEAR(std::abs(std::remainder(middle - pi, 2 * pi)), 0, 1e-5);
}

}  // namespace
}  // namespace wellspring
