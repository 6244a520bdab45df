// SPDX-License-Identifier: Apache-2.0
// Marks at the times of their words, and subtitles in and out.
#include <gtest/gtest.h>

#include "avatar/body/gesture.h"
#include "avatar/speech/process.h"
#include "avatar/story/story_script.h"
#include "avatar/story/subtitle.h"
#include "avatar/story/timeline.h"
#include "base/load_error.h"

namespace wellspring::test {
namespace {

Speech speak(const SpeechRequest& request) {
  SpeechProcess process;
  std::string error;
  auto speech = process.speak(request, error);
  EXPECT_TRUE(speech) << error;
  return speech ? *speech : Speech{};
}

double begin_of(const Speech& speech, const std::string& word) {
  for (const SpeechWord& w : speech.words)
    if (speech.text.substr(w.text_begin, w.text_end - w.text_begin) == word) return w.begin;
  ADD_FAILURE() << "no word " << word;
  return -1;
}

TEST(Timeline, MarksComeWithTheirWords) {
  StoryLine line = read_story_line(
                       "<emotion name='joy'/>The old well keeps <gesture name='invite'/>every "
                       "<emphasis>single</emphasis> voice.<look at='visitor'/>",
                       "a")
                       .lines[0];
  Speech speech = speak({.text = line.text, .styles = line.styles});
  ASSERT_FALSE(speech.words.empty());
  Timeline timeline = make_timeline(line, &speech, 0);
  ASSERT_EQ(timeline.actions.size(), 4u);
  const auto& [emotion, gesture, beat, look] =
      std::tie(timeline.actions[0], timeline.actions[1], timeline.actions[2], timeline.actions[3]);
  EXPECT_EQ(emotion.event.kind, StoryMarkKind::emotion);
  EXPECT_NEAR(emotion.time, begin_of(speech, "The"), 1e-9);
  EXPECT_EQ(gesture.event.name, "invite");
  EXPECT_NEAR(gesture.time + double(gesture.event.lead), begin_of(speech, "every"), 1e-6);
  float stroke = default_gestures().clips.at(size_t(find_gesture("invite"))).stroke;
  EXPECT_NEAR(gesture.event.lead,
              std::min(double(stroke), begin_of(speech, "every") - earliest_action), 1e-6);
  EXPECT_EQ(beat.event.kind, StoryMarkKind::beat);
  EXPECT_NEAR(beat.time, begin_of(speech, "single"), 1e-9);
  EXPECT_NEAR(look.time + double(look.event.lead), speech.words.back().end, 1e-6);
}

TEST(Timeline, WhatIsHeldIsThereWithItsWordAndUntilItIsPutAway) {
  std::vector<StoryLine> lines =
      read_story("One two three <hold name='torch'/>four. Five. <hold name='nothing'/>Six.", "a")
          .lines;
  ASSERT_EQ(lines.size(), 3u);
  Timeline timeline = make_timeline(lines[0], nullptr, 10);
  ASSERT_EQ(timeline.actions.size(), 1u);
  EXPECT_EQ(timeline.actions[0].event.kind, StoryMarkKind::hold);
  EXPECT_NEAR(timeline.actions[0].event.lead, hold_lead, 1e-6);
  EXPECT_EQ(hold_before(lines, 0).prop, "");
  EXPECT_EQ(hold_before(lines, 1).prop, "torch");
  EXPECT_EQ(hold_before(lines, 2).prop, "torch") << "longer than a sentence";
  EXPECT_EQ(hold_before(lines, 3).prop, "");
  EXPECT_THROW(read_story("One <hold/>two.", "a"), LoadError);
}

TEST(Timeline, ShowsPiecesWithTheirWords) {
  const StoryLine line =
      read_story_line("One <show piece='falcon' layer='bone' turn='40'/>two.", "a").lines[0];
  const Timeline timeline = make_timeline(line, nullptr, 8);
  ASSERT_EQ(timeline.actions.size(), 1u);
  EXPECT_NEAR(timeline.actions[0].time, 4, 1e-6);
  EXPECT_EQ(timeline.actions[0].event.name, "falcon");
  EXPECT_EQ(timeline.actions[0].event.piece.layer, "bone");
  EXPECT_EQ(timeline.actions[0].event.piece.turn, 40);
}

TEST(Timeline, EventsDoNotDependOnTheStep) {
  StoryLine line =
      read_story_line("<gesture name='a'/>One <gesture name='b'/>two <gesture name='c'/>three.",
                      "a")
          .lines[0];
  Timeline timeline = make_timeline(line, nullptr, 3);
  auto run = [&](double step) {
    std::vector<std::string> names;
    size_t cursor = 0;
    for (double now = -0.3; now < 4; now += step)
      for (const ActionEvent* event : advance_timeline(timeline, cursor, now))
        names.push_back(event->name);
    return names;
  };
  for (double step : {0.001, 0.01, 0.37, 2.0})
    EXPECT_EQ(run(step), (std::vector<std::string>{"a", "b", "c"})) << step;
  size_t cursor = 0;
  EXPECT_EQ(advance_timeline(timeline, cursor, 1e9).size(), 3u);
  EXPECT_EQ(advance_timeline(timeline, cursor, 1e9).size(), 0u);
}

TEST(Timeline, WhatHoldsBeforeALineIsWhatWasToldBefore) {
  StoryScript script = read_story(
      "<emotion name='joy' weight='0.4'/><look at='well'/>An ant. <point at='crown'/>A bee. "
      "<emotion name='neutral'/>A cow.",
      "a");
  EXPECT_EQ(hold_before(script.lines, 0).emotion, "");
  EXPECT_EQ(hold_before(script.lines, 1).emotion, "joy");
  EXPECT_FLOAT_EQ(hold_before(script.lines, 1).emotion_weight, 0.4f);
  EXPECT_EQ(hold_before(script.lines, 1).look, "well");
  EXPECT_EQ(hold_before(script.lines, 2).look, "crown");
  EXPECT_EQ(hold_before(script.lines, 2).point, "");
  EXPECT_EQ(hold_before(script.lines, 99).emotion, "");
}

// Styles change the sound, and words are still found in it.
TEST(SpeechStyleSound, PausesSlownessAndOtherWordsAreHeard) {
  const std::string text = "In 1786 the well fell silent at last.";
  Speech plain = speak({.text = text});
  SpeechStyle pause, alias{3, 7, 1, 1, 1, 0, "that year", 0}, slow{22, 28, 0.5f};
  pause.begin = pause.end = 29;
  pause.pause = 0.8f;
  Speech styled = speak({.text = text, .styles = {pause, alias, slow}});
  ASSERT_EQ(styled.words.size(), 8u);
  for (size_t i = 0; i < 8; i++)
    EXPECT_EQ(styled.words[i].text_begin, plain.words[i].text_begin) << i;
  auto length = [](const Speech& speech, size_t word) {
    return speech.words[word].end - speech.words[word].begin;
  };
  EXPECT_GT(length(styled, 5), 1.4 * length(plain, 5));         // "silent"
  EXPECT_LT(length(styled, 1), 0.7 * length(plain, 1));         // "that year" for "1786"
  EXPECT_GT(styled.words[6].begin - styled.words[5].end, 0.6);  // the pause before "at"
  EXPECT_NEAR(length(styled, 7), length(plain, 7), 0.35 * length(plain, 7));
}

TEST(SpeechStyleSound, VariantsOfAVoiceDiffer) {
  Speech plain = speak({.text = "The well."}),
         other = speak({.text = "The well.", .variant = "f3"});
  EXPECT_NE(plain.pcm, other.pcm);
  SpeechProcess process;
  std::string error;
  EXPECT_FALSE(process.speak({.text = "The well.", .variant = "nobody"}, error));
  EXPECT_NE(error.find("nobody"), std::string::npos);
  EXPECT_FALSE(process.speak({.text = "The well.", .variant = "../x"}, error));
}

TEST(Subtitles, ComeBackAsTheyWere) {
  std::vector<SubtitleCue> cues = {{0, 2.5, "Tom & <Jerry> --> run\nand run", "Ludmila"},
                                   {3600.25, 3661.001, "Žriedlo", ""}};
  auto back = load_subtitles(write_subtitles(cues), "a.vtt").cues;
  ASSERT_EQ(back.size(), 2u);
  for (size_t i = 0; i < 2; i++) {
    EXPECT_EQ(back[i].text, cues[i].text);
    EXPECT_EQ(back[i].speaker, cues[i].speaker);
    EXPECT_NEAR(back[i].begin, cues[i].begin, 5e-4);
    EXPECT_NEAR(back[i].end, cues[i].end, 5e-4);
  }
}

TEST(Subtitles, OthersFilesAreRead) {
  auto cues =
      load_subtitles(
          "\xef\xbb\xbfWEBVTT - title\r\nKind: captions\r\n\r\nNOTE a\r\nnote --> not a cue\r\n\r\n"
          "STYLE\r\n::cue { color: red }\r\n\r\n"
          "intro\r\n00:05.000 --> 00:06.500 align:start line:0\r\n<c.red>Late</c> &amp; "
          "<i>last</i>\r\n\r\n"
          "00:01.000\t-->\t00:02.000\r\n<v Old Anna>First</v>\r\nline <00:01.500>two",
          "a.vtt")
          .cues;
  ASSERT_EQ(cues.size(), 2u);
  EXPECT_EQ(cues[0].text, "First\nline two");
  EXPECT_EQ(cues[0].speaker, "Old Anna");
  EXPECT_EQ(cues[1].text, "Late & last");
  EXPECT_DOUBLE_EQ(cues[1].end, 6.5);
}

TEST(Subtitles, MistakesHaveTheirLine) {
  for (auto [text, line] : std::vector<std::pair<std::string, std::string>>{
           {"", "line 1"},
           {"WEBVTTX\n", "line 1"},
           {"WEBVTT\n\n00:01.000 --> soon\nx", "line 3"},
           {"WEBVTT\n\n00:99.000 --> 01:00:00.000\nx", "line 3"},
           {"WEBVTT\n\n1:1.000 --> 00:01:03.000\nx", "line 3"},
           {"WEBVTT\n\n00:02.000 --> 00:01.000\nx", "line 3"},
           {"WEBVTT\n\n00:01.000 --> 00:02.000\n\xff", "line 4"}}) {
    try {
      load_subtitles(text, "a.vtt");
      ADD_FAILURE() << text;
    } catch (const LoadError& error) {
      EXPECT_EQ(error.where, line) << text;
    }
  }
}

TEST(Subtitles, ReferencesAreWhatTheyStandFor) {
  const std::string head = "WEBVTT\n\n00:01.000 --> 00:02.000\n";
  for (auto [written, read] : std::vector<std::pair<std::string, std::string>>{
           {"isn&#39;t &#x27;t", "isn't 't"},
           {"&lt;i&gt; &amp; &quot;x&quot; &apos;", "<i> & \"x\" '"},
           {"caf&eacute;&nbsp;&hellip; 5&nbsp;&euro; &ndash; &thetasym;",
            "café\u00a0… 5\u00a0€ – ϑ"},
           {"&#150; &#x96; &#128;", "– – €"},
           {"&#127994;", "🏺"},
           {"&nobody; &#; &#x; & &#55296; &#1114112; AT&T; &",
            "&nobody; &#; &#x; & &#55296; "
            "&#1114112; AT&T; &"}}) {
    auto cues = load_subtitles(head + written, "a.vtt").cues;
    ASSERT_EQ(cues.size(), 1u) << written;
    EXPECT_EQ(cues[0].text, read);
  }
  auto named =
      load_subtitles(head + "<v.loud Tom &amp; Ann>Hello</v> <v Bob>you</v>", "a.vtt").cues;
  EXPECT_EQ(named[0].speaker, "Tom & Ann");
  EXPECT_EQ(named[0].text, "Hello you");
}

TEST(Subtitles, BlocksWithoutTimesAreNoCues) {
  Subtitles read = load_subtitles(
      "WEBVTT\rX-TIMESTAMP-MAP=LOCAL:00:00:00.000,MPEGTS:0\r\rNOTES of somebody\rwho wrote\r\r"
      "REGION\rid:fred\r\r1\r123:00:03.000-->1234:00:04.500 align:start\rLate\r"
      "00:01.000 --> 00:02.000\rFirst\r\rNOTE\rnothing\r\rlonely",
      "a.vtt");
  ASSERT_EQ(read.cues.size(), 2u);
  EXPECT_EQ(read.cues[0].text, "First");
  EXPECT_EQ(read.cues[0].line, 14);
  EXPECT_EQ(read.cues[1].text, "Late");
  EXPECT_DOUBLE_EQ(read.cues[1].begin, 123 * 3600 + 3);
  ASSERT_EQ(read.notes.size(), 2u);
  EXPECT_EQ(read.notes[0].first, 4);
  EXPECT_EQ(read.notes[1].first, 19);
}

TEST(Subtitles, AreAStoryWhoseSentencesMayGoOnInTheNextCue) {
  StoryScript script = read_subtitle_story(
      "WEBVTT\n\n00:05.000 --> 00:06.000\nit was warm. Then\nit rained.\n\n"
      "00:01.000 --> 00:02.000\n<v Ann>Have a cup of tea &amp; sit,\n\nodd\nblock\n",
      "a.vtt");
  ASSERT_EQ(script.lines.size(), 2u);
  EXPECT_EQ(script.lines[0].text, "Have a cup of tea & sit, it was warm.");
  EXPECT_EQ(script.lines[0].place.line, 8);
  EXPECT_EQ(script.lines[1].text, "Then it rained.");
  EXPECT_EQ(script.lines[1].place.line, 4);
  ASSERT_EQ(script.notes.size(), 1u);
  EXPECT_EQ(script.notes[0].place.line, 10);
  EXPECT_THROW(read_subtitle_story("WEBVTT\n\nNOTE nothing\n", "a.vtt"), LoadError);
}

}  // namespace
}  // namespace wellspring::test
