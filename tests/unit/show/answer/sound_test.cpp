// SPDX-License-Identifier: Apache-2.0
// Speech in the show: how long it lasts, how long it is waited for, what is sent to whom, and its
// end.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "show/answer/events.h"
#include "unit/show/show_stage.h"
#include "unit/wire/sound_view.h"
#include "wire/packet.h"

namespace wellspring::test {
namespace {

std::shared_ptr<const Speech> make_speech(const std::string& text, const std::string& lang,
                                          double seconds, int rate = 8000) {
  auto speech = std::make_shared<Speech>();
  speech->text = text;
  speech->lang = lang;
  speech->rate = rate;
  speech->pcm.resize(size_t(seconds * speech->rate));
  for (size_t i = 0; i < speech->pcm.size(); i++) speech->pcm[i] = int16_t(i % 4096);
  speech->duration = seconds;
  VisemeKey silent, open;
  silent.weights[size_t(Viseme::sil)] = 1;
  open.weights[size_t(Viseme::aa)] = 1;
  open.time = 0.1;
  silent.time = 0;
  speech->visemes.keys = {silent, open};
  silent.time = seconds;
  speech->visemes.keys.push_back(silent);
  return speech;
}

TEST(VoiceWithSpeech, LastsAsLongAsItsSpeechAndABreath) {
  Voice voice;
  say(voice, plain_line({{"en", "Short."}}), false);
  auto speech = make_speech("Short.", "en", 3);
  AskSpeech ask = [&](const Utterance&) { return SpeechState{speech, false, "en"}; };
  ASSERT_TRUE(advance_voice(voice, 0.01f, ask).begun);
  EXPECT_EQ(heard(voice), speech.get());
  EXPECT_EQ(speaking(voice), 0) << "the breath before it";
  float seconds = 0;
  bool moved = false;
  for (; !voice.queue.empty() && seconds < 20; seconds += 0.01f) {
    moved |= speaking(voice) > 0.9f;
    advance_voice(voice, 0.01f, ask);
  }
  EXPECT_TRUE(moved);
  EXPECT_NEAR(seconds, speech_lead + 3 + 0.35f, 0.03f);
  EXPECT_EQ(heard(voice), nullptr);
}

TEST(VoiceWithSpeech, WaitsABoundedTimeThenTellsBySubtitles) {
  Voice voice;
  tell(voice, make_tiny_exhibit().stories[0]);
  bool there = false;
  auto speech = make_speech("Two.", "en", 1);
  AskSpeech ask = [&](const Utterance&) {
    return there ? SpeechState{speech, false, "en"} : SpeechState{nullptr, true, "en"};
  };
  float waited = 0;
  while (!advance_voice(voice, 0.05f, ask).begun && waited < 10) waited += 0.05f;
  EXPECT_NEAR(waited, longest_wait, 0.11f);
  EXPECT_EQ(heard(voice), nullptr);
  EXPECT_FLOAT_EQ(voice.queue.front().seconds, speaking_seconds(voice.queue.front().line));
  // The next line waits anew, and no longer than it must.
  while (voice.sentence == 0) advance_voice(voice, 0.05f, ask);
  EXPECT_FALSE(voice.started);
  advance_voice(voice, 0.5f, ask);
  there = true;
  EXPECT_TRUE(advance_voice(voice, 0.05f, ask).begun);
  EXPECT_EQ(heard(voice), speech.get());
  voice.paused = true;
  EXPECT_EQ(heard(voice), nullptr);
  EXPECT_EQ(speaking(voice, 0.3f), 0);
}

// A show with a storyteller of one joint, and a speaker of 2 s a line.
struct SoundTest : testing::Test, ShowStage {
  std::map<std::string, std::shared_ptr<const Speech>> kept;
  std::vector<SpeechRequest> asked;
  int spoken = 0;

  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    for (int i : {0, 1}) {
      StorytellerPlace& storyteller_place =
          add_storyteller(exhibit, i == 0 ? "anna" : "otto", {1, 0, 2 - 0.5 * i});
      storyteller_place.character.positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}};
      storyteller_place.character.normals.assign(3, {0, 0, 1});
    }
    exhibit.storytellers[1].voice.variant = "m2";
    tick_seconds = 0.04;
    exhibit.shared_storyteller = true;
    begin(std::move(exhibit), settings_for("direct"));
    show->cast.speech.find = [this](const SpeechRequest& r) {
      return kept.contains(r.text) ? kept[r.text] : nullptr;
    };
    show->cast.speech.speak = [this](const SpeechRequest& r) {
      spoken++;
      asked.push_back(r);
      kept[r.text] = make_speech(r.text, r.lang, 2);
      std::promise<SpeechAnswer> promise;
      promise.set_value({kept[r.text], {}});
      return promise.get_future().share();
    };
  }
  size_t join(const std::string& lang) { return ShowStage::join(32, 32, lang); }
  std::vector<nlohmann::json> speech(size_t visitor) { return told("speech", visitor); }
  std::vector<nlohmann::json> subtitles(size_t visitor) { return told("subtitle", visitor); }
  std::vector<test::SoundView> sounds(size_t visitor) {
    std::vector<test::SoundView> read;
    for (const Packet& packet : browsers[visitor].sounds)
      if (auto sound = test::read_sound_packet(packet)) read.push_back(std::move(*sound));
    return read;
  }
};

TEST_F(SoundTest, AWholeLineArrivesInOrderAndAheadOfItsTime) {
  size_t a = join("en");
  run(0.2);
  say(R"({"type":"storyteller","story":"tale"})", a);
  run(2.4);
  ASSERT_EQ(speech(a).size(), 1u);
  EXPECT_EQ(speech(a)[0]["action"], "start");
  EXPECT_EQ(speech(a)[0]["text"], "One.");
  EXPECT_EQ(speech(a)[0]["seconds"], 2.0);
  const std::vector<test::SoundView> pieces = sounds(a);
  ASSERT_EQ(pieces.size(), 8u);
  std::vector<int16_t> all;
  for (const test::SoundView& sound : pieces) {
    EXPECT_EQ(sound.header.start, all.size());
    EXPECT_EQ(sound.header.total, 16000u);
    EXPECT_EQ(sound.header.utterance, speech(a)[0]["utterance"]);
    EXPECT_EQ(sound.header.time_us - pieces[0].header.time_us, uint64_t(sound.header.start) * 125);
    EXPECT_NEAR(glm::length(sound.header.mouth - dvec3(1, 1.5, 2)), 0, 0.2);
    all.insert(all.end(), sound.samples.begin(), sound.samples.end());
  }
  EXPECT_EQ(all, kept["One."]->pcm);
  run(2);
  ASSERT_EQ(speech(a).size(), 2u) << "an end is no stop";
  EXPECT_EQ(speech(a)[1]["text"], "Two.");
}

TEST_F(SoundTest, StopPauseAndRestartAreHeardAtOnce) {
  size_t a = join("en");
  run(0.2);
  say(R"({"type":"storyteller","story":"tale"})", a);
  run(0.4);
  size_t sent = sounds(a).size();
  EXPECT_LT(sent, 8u) << "no more than is due soon";
  say(R"({"type":"storyteller","action":"pause"})", a);
  run(0.2);
  ASSERT_EQ(speech(a).size(), 2u);
  EXPECT_EQ(speech(a)[1]["action"], "stop");
  EXPECT_EQ(sounds(a).size(), sent);
  say(R"({"type":"storyteller","action":"play"})", a);
  run(0.1);
  ASSERT_EQ(speech(a).size(), 3u);
  EXPECT_GT(speech(a)[2]["utterance"], speech(a)[0]["utterance"]);
  EXPECT_GT(sounds(a).back().header.start, 0u) << "it goes on where it was";
  say(R"({"type":"storyteller","action":"restart"})", a);
  run(0.1);
  ASSERT_EQ(speech(a).size(), 5u) << "the same line again is another utterance";
  EXPECT_EQ(speech(a)[3]["action"], "stop");
  say(R"({"type":"storyteller","action":"stop"})", a);
  run(0.1);
  EXPECT_EQ(speech(a).back()["action"], "stop");
  sent = sounds(a).size();
  run(1);
  EXPECT_EQ(sounds(a).size(), sent);
}

TEST_F(SoundTest, OneLanguageIsSpokenAndEverybodyReadsTheirOwn) {
  size_t a = join("en"), b = join("de");
  run(0.2);
  say(R"({"type":"storyteller","story":"tale"})", b);
  run(0.5);
  for (size_t peer : {a, b}) {
    ASSERT_FALSE(speech(peer).empty());
    EXPECT_EQ(speech(peer)[0]["lang"], "de");
    EXPECT_EQ(speech(peer)[0]["text"], "Eins.");
  }
  EXPECT_EQ(subtitles(a)[0]["text"], "One.");
  EXPECT_EQ(subtitles(b)[0]["text"], "Eins.");
}

TEST_F(SoundTest, NothingIsMadeForThoseWhoDoNotListenAndALateListenerHearsTheRest) {
  size_t a = join("en");
  say(R"({"type":"settings","sound":false})", a);
  run(0.2);
  say(R"({"type":"storyteller","story":"tale"})", a);
  run(0.2);
  EXPECT_EQ(spoken, 0);
  EXPECT_EQ(subtitles(a).size(), 1u) << "told by subtitles, at once";
  kept["Two."] = make_speech("Two.", "en", 2);
  run(2.0);
  EXPECT_EQ(subtitles(a).size(), 2u);
  EXPECT_TRUE(sounds(a).empty() && speech(a).empty());
  EXPECT_EQ(show->totals.sounds, 0u);
  EXPECT_TRUE(heard(show->cast.teller.voice)) << "the mouth follows what was prepared all the same";
  say(R"({"type":"settings","sound":true})", a);
  run(0.1);
  ASSERT_FALSE(sounds(a).empty());
  EXPECT_GT(sounds(a)[0].header.start, 4000u);
}

TEST_F(SoundTest, AListenerWhoDoesNotReadLosesTheWholeUtterance) {
  size_t a = join("en"), b = join("en");
  run(0.2);
  for (const char* text : {"One.", "Two."}) kept[text] = make_speech(text, "en", 20, 32000);
  say(R"({"type":"storyteller","story":"tale"})", b);
  browsers[a].reads = false;
  run(6);
  EXPECT_EQ(show->totals.sounds_given_up, 1u);
  EXPECT_GE(sounds(b).size(), 20u);
  Link::Out out;
  while (browsers[a].link->take_out(out))
    EXPECT_FALSE(out.binary && test::read_sound_packet(*out.packet));
}

// ---- what a story's marks do ----

std::shared_ptr<const Speech> make_worded(const std::string& text, double seconds) {
  auto speech = std::make_shared<Speech>(*make_speech(text, "en", seconds));
  double begin = 0, each = seconds / 3;
  for (uint32_t at = 0; at < text.size(); begin += each) {
    uint32_t end = uint32_t(std::min(text.find(' ', at), text.size()));
    speech->words.push_back({begin, begin + each, at, end});
    at = end + 1;
  }
  return speech;
}

TEST(VoiceWithSpeech, ResumesWithTheWordThatWasBroken) {
  Voice voice;
  say(voice, plain_line({{"en", "one two three"}}), false);
  auto speech = make_worded("one two three", 3);
  AskSpeech ask = [&](const Utterance&) { return SpeechState{speech, false, "en"}; };
  advance_voice(voice, 0.01f, ask);
  while (voice.elapsed < 1.5f) advance_voice(voice, 0.01f, ask);
  pause_voice(voice);
  EXPECT_EQ(mouth_shape(voice)[size_t(Viseme::sil)], 1);
  advance_voice(voice, 100, ask);
  resume_voice(voice);
  EXPECT_NEAR(voice.elapsed, 1 - speech_lead, 1e-5);
  EXPECT_EQ(voice.silent_until, 1);
  EXPECT_EQ(mouth_shape(voice)[size_t(Viseme::sil)], 1) << "nothing is heard yet";
  EXPECT_LT(mouth_shape(voice, speech_lead + 0.05f)[size_t(Viseme::sil)], 0.5f);
  resume_voice(voice);
  EXPECT_NEAR(voice.elapsed, 1 - speech_lead, 1e-5) << "twice is once";
}

TEST(VoiceWithSpeech, MarksBecomeEventsAtTheirWordsOnce) {
  Voice voice;
  StoryText story{.id = "s"};
  story.text["en"] =
      read_story("<emotion name='joy' weight='0.5'/>one <emphasis>two</emphasis> three.", "a")
          .lines;
  tell(voice, story);
  auto speech = make_worded("one two three.", 3);
  AskSpeech ask = [&](const Utterance&) { return SpeechState{speech, false, "en"}; };
  std::vector<std::pair<StoryMarkKind, float>> seen;
  for (int i = 0; i < 400; i++) {
    float at = voice.elapsed;
    bool again = i == 250;
    if (again) {
      pause_voice(voice);
      resume_voice(voice);
    }
    for (const ActionEvent& act : advance_voice(voice, 0.01f, ask).acts)
      seen.emplace_back(act.kind, at);
    if (voice.started && voice.elapsed > 0.1f) {
      EXPECT_EQ(voice.held.emotion, "joy");
    }
  }
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].first, StoryMarkKind::emotion);
  EXPECT_EQ(seen[1].first, StoryMarkKind::beat);
  EXPECT_NEAR(seen[1].second, 1, 0.02);
  while (!voice.queue.empty()) advance_voice(voice, 0.1f, ask);
  EXPECT_EQ(voice.held.emotion, "") << "the face is her own again";
}

TEST(VoiceWithSpeech, SkippingLeavesTheFaceAsIfAllHadBeenTold) {
  StoryText story{.id = "s"};
  story.text["en"] =
      read_story("<emotion name='sadness'/><look at='well'/>First. Second. Third.", "a").lines;
  Voice voice;
  tell(voice, story, 2);
  EXPECT_EQ(voice.held.emotion, "sadness");
  EXPECT_EQ(voice.held.look, "well");
  EXPECT_EQ(voice.queue.size(), 1u);
  tell(voice, story, 7);
  EXPECT_TRUE(voice.queue.empty() && voice.story.empty());
}

// ---- one storyteller for all ----

TEST_F(SoundTest, AnybodyMayStopWhatAnotherAskedForAndBothAreTold) {
  size_t a = join("en"), b = join("en");
  run(0.2);
  say(R"({"type":"storyteller","story":"tale"})", a);
  run(0.4);
  EXPECT_EQ(speech(b).at(0)["text"], "One.") << "who is there listens in";
  say(R"({"type":"storyteller","action":"stop"})", b);
  run(0.2);
  EXPECT_EQ(show->cast.teller.voice.story, "");
  for (size_t peer : {a, b}) {
    EXPECT_EQ(speech(peer).back()["action"], "stop");
    EXPECT_EQ(subtitles(peer).back()["text"], "");
  }
}

TEST_F(SoundTest, AStoryGoesOnWithoutWhoAskedUnlessItWasPaused) {
  for (bool paused : {false, true}) {
    size_t a = join("en"), b = join("en");
    run(0.2);
    say(R"({"type":"storyteller","story":"tale"})", a);
    run(0.4);
    if (paused) say(R"({"type":"storyteller","action":"pause"})", a);
    run(0.2);
    say(R"({"type":"bye"})", a);
    run(0.2);
    EXPECT_EQ(show->cast.teller.voice.story, paused ? "" : "tale");
    say(R"({"type":"bye"})", b);
    run(0.2);
    EXPECT_EQ(show->cast.teller.voice.story, "") << "nobody is left to hear it";
    EXPECT_TRUE(show->cast.teller.voice.queue.empty());
  }
}

TEST_F(SoundTest, NobodyFarAwayTakesTheStorytellerFromWhoStandsBeforeIt) {
  size_t a = join("en"), b = join("en");
  run(0.2);
  show->visits.visitors.front().kiosk = true;
  say(R"({"type":"storyteller","story":"tale"})", a);
  run(0.4);
  uint64_t refused = show->totals.refused_messages;
  for (const char* text : {R"("action":"stop")", R"("action":"pause")", R"("visible":false)",
                           R"("teller":"otto")", R"("story":"tale")"}) {
    say(R"({"type":"storyteller",)" + std::string(text) + "}", b);
    run(0.08);
  }
  EXPECT_EQ(show->totals.refused_messages, refused + 5);
  EXPECT_EQ(show->cast.teller.voice.story, "tale");
  EXPECT_EQ(show->cast.teller.voice.asked_by, browsers[a].link->id);
  EXPECT_TRUE(show->cast.teller.visible);
  EXPECT_EQ(show->cast.teller.index, 0u);
  EXPECT_FALSE(show->cast.teller.voice.paused);
  // The kiosk may, and afterwards everybody may again.
  say(R"({"type":"storyteller","action":"stop"})", a);
  run(0.1);
  say(R"({"type":"storyteller","story":"tale"})", b);
  run(0.1);
  EXPECT_EQ(show->cast.teller.voice.asked_by, browsers[b].link->id);
  say(R"({"type":"storyteller","action":"stop"})", a);
  run(0.1);
  EXPECT_EQ(show->cast.teller.voice.story, "") << "who stands before it comes first";
}

// ---- the narrator of a tour ----

TEST_F(SoundTest, ATourIsHeardByItsVisitorAloneAndEverywhere) {
  size_t a = join("en"), b = join("en");
  run(0.2);
  say(R"({"type":"tour","action":"play"})", a);
  run(1.5);
  ASSERT_FALSE(speech(a).empty());
  EXPECT_EQ(speech(a)[0]["text"], "Here");
  ASSERT_FALSE(sounds(a).empty());
  EXPECT_EQ(sounds(a)[0].header.flags & 1, 1);
  EXPECT_EQ(subtitles(a).at(0)["text"], "Here");
  EXPECT_EQ(subtitles(a).at(0)["speaker"], "");
  EXPECT_TRUE(speech(b).empty() && sounds(b).empty() && subtitles(b).empty());
  // The storyteller tells somebody else something meanwhile: not to who is on the tour.
  say(R"({"type":"storyteller","story":"tale"})", b);
  run(0.5);
  EXPECT_EQ(speech(b).at(0)["text"], "One.");
  EXPECT_EQ(speech(a).size(), 1u);
  // Pause is heard at once; the same line goes on later under another number.
  say(R"({"type":"tour","action":"pause"})", a);
  run(0.1);
  EXPECT_EQ(speech(a).at(1)["action"], "stop");
  say(R"({"type":"tour","action":"play"})", a);
  run(0.3);
  EXPECT_EQ(speech(a).back()["action"], "start");
  EXPECT_EQ(speech(a).back()["text"], "Here");
  say(R"({"type":"tour","action":"stop"})", a);
  run(0.03);
  EXPECT_EQ(subtitles(a).back()["text"], "") << "the line goes with the voice";
  run(0.07);
  // The storyteller's words to the other visitor are heard again.
  ASSERT_GE(speech(a).size(), 5u);
  EXPECT_EQ(speech(a)[3]["action"], "stop");
  EXPECT_NE(speech(a)[4]["text"], "Here");
}

TEST_F(SoundTest, WhoHasTheirOwnStorytellerHearsHerAlone) {
  show->stage.exhibit.shared_storyteller = false;
  size_t a = join("en"), b = join("de");
  run(0.2);
  say(R"({"type":"storyteller","story":"tale"})", a);
  run(0.4);
  say(R"({"type":"storyteller","story":"tale"})", b);
  run(0.4);
  ASSERT_EQ(speech(a).size(), 1u);
  ASSERT_EQ(speech(b).size(), 1u);
  EXPECT_EQ(speech(a)[0]["lang"], "en");
  EXPECT_EQ(speech(b)[0]["lang"], "de");
  EXPECT_NE(speech(a)[0]["utterance"], speech(b)[0]["utterance"]);
  for (const test::SoundView& sound : sounds(b))
    EXPECT_EQ(sound.header.utterance, speech(b)[0]["utterance"]);
  say(R"({"type":"storyteller","action":"stop"})", a);
  run(0.4);
  EXPECT_EQ(speech(a).back()["action"], "stop");
  EXPECT_EQ(speech(b).size(), 1u);
}

TEST_F(SoundTest, AFarewellCutsTheStoryShort) {
  size_t a = join("en");
  run(0.2);
  say(R"({"type":"storyteller","story":"tale"})", a);
  run(0.4);
  EXPECT_EQ(show->cast.teller.voice.story, "tale");
  wellspring::show::say(show->cast.teller.voice, plain_line({{"en", "Goodbye."}}), true);
  run(0.4);
  EXPECT_EQ(show->cast.teller.voice.story, "");
  ASSERT_GE(speech(a).size(), 3u);
  EXPECT_EQ(speech(a)[1]["action"], "stop");
  EXPECT_EQ(speech(a)[2]["text"], "Goodbye.");
}

}  // namespace
}  // namespace wellspring::test
