// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "show/storyteller/voice.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

TEST(Voice, SaysAStorySentenceBySentence) {
  Voice voice;
  Exhibit exhibit = make_tiny_exhibit();
  tell(voice, exhibit.stories[0]);
  std::vector<std::string> said;
  int silences = 0;
  for (int i = 0; i < 1000; i++) {
    VoiceEvents events = advance_voice(voice, 0.01f);
    if (events.begun) said.push_back(events.begun->line.at("de").text);
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
  say(voice, plain_line({{"en", "Goodbye"}}), true);
  VoiceEvents events = advance_voice(voice, 0.01f);
  ASSERT_TRUE(events.begun);
  EXPECT_EQ(events.begun->line.at("en").text, "Goodbye");
  EXPECT_TRUE(voice.story.empty());
}

TEST(Voice, PauseHoldsAndTheMouthRests) {
  Voice voice;
  say(voice, plain_line({{"en", "A sentence of some length."}}), false);
  for (int i = 0; i < 50; i++) advance_voice(voice, 0.02f);
  EXPECT_GT(speaking(voice), 0.9f);
  pause_voice(voice);
  float elapsed = voice.elapsed;
  advance_voice(voice, 100);
  EXPECT_EQ(voice.elapsed, elapsed);
  EXPECT_EQ(speaking(voice), 0);
}

TEST(Voice, LengthFollowsCharactersNotBytes) {
  auto seconds = [](const LocalText& text) { return speaking_seconds(plain_line(text)); };
  EXPECT_FLOAT_EQ(seconds({{"sk", "čšž"}}), seconds({{"en", "csz"}}));
  EXPECT_GT(seconds({{"en", "a"}, {"de", "much longer"}}), seconds({{"en", "a"}}));
}

TEST(Voice, EmptyAndHugeSteps) {
  Voice voice;
  EXPECT_FALSE(advance_voice(voice, 1e9f).begun);
  say(voice, LocalLine{}, true);
  EXPECT_TRUE(voice.queue.empty());
  EXPECT_EQ(nth_line({}, 3).size(), 0u);
  LocalScript script;
  script["en"].resize(2);
  script["en"][1].text = "b";
  EXPECT_EQ(nth_line(script, 3).at("en").text, "b");
}

}  // namespace
}  // namespace wellspring::test
