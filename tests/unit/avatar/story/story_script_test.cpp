// SPDX-License-Identifier: Apache-2.0
// The story format: what is said, where its marks stand, and what is wrong with a text.
#include <gtest/gtest.h>

#include <cmath>

#include "avatar/speech/text.h"
#include "avatar/story/story_markup.h"
#include "avatar/story/story_script.h"
#include "base/load_error.h"
#include "base/rng.h"

namespace wellspring::test {
namespace {

std::vector<std::string> texts(const StoryScript& script) {
  std::vector<std::string> list;
  for (const StoryLine& line : script.lines) list.push_back(line.text);
  return list;
}
using Texts = std::vector<std::string>;

// The text that a mark stands before.
std::string after(const StoryLine& line, const StoryMark& mark) {
  return line.text.substr(mark.at);
}

const StoryMark* find(const StoryLine& line, StoryMarkKind kind) {
  for (const StoryMark& mark : line.marks)
    if (mark.kind == kind) return &mark;
  return nullptr;
}

TEST(StoryScript, PlainTextIsSentencesAndParagraphs) {
  StoryScript script = read_plain_story(
      "Once upon a time,\nthere was a well. It had <no> water & no rope!\n\n“Why?” asked Matej.",
      "a");
  EXPECT_EQ(texts(script), (Texts{"Once upon a time, there was a well.",
                                  "It had <no> water & no rope!", "“Why?” asked Matej."}));
  EXPECT_EQ(script.lines[0].pause, 0);
  EXPECT_EQ(script.lines[1].pause, paragraph_pause);
  EXPECT_EQ(script.lines[2].place.line, 4);
  EXPECT_TRUE(script.notes.empty());
}

TEST(StoryScript, SentencesEndInEveryLanguageOfTheCastle) {
  auto split = [](std::string_view text) {
    std::vector<std::string> list;
    for (TextSpan span : find_sentences(text))
      list.emplace_back(text.substr(span.begin, span.end - span.begin));
    return list;
  };
  EXPECT_EQ(split("Im 13. Jahrhundert war z. B. hier Wald. Danach nicht."),
            (Texts{"Im 13. Jahrhundert war z. B. hier Wald.", "Danach nicht."}));
  EXPECT_EQ(split("That was in 1786. Then nothing."),
            (Texts{"That was in 1786.", "Then nothing."}));
  EXPECT_EQ(split("„Kto je tam?“ spýtal sa. Čas plynul… Šli ďalej."),
            (Texts{"„Kto je tam?“ spýtal sa.", "Čas plynul…", "Šli ďalej."}));
  EXPECT_EQ(split("Počkal… čakal ďalej."), (Texts{"Počkal… čakal ďalej."}));
  EXPECT_EQ(split("水があった。井戸は深い。"), (Texts{"水があった。", "井戸は深い。"}));
  EXPECT_EQ(split("No end"), (Texts{"No end"}));
  EXPECT_TRUE(split("  \n ").empty());
}

TEST(StoryScript, MarksStandBeforeTheirWords) {
  StoryScript script = read_story(
      "<story><p><emotion name=\"sadness\" weight=\"0.6\"/>He dug for <emphasis>three</emphasis> "
      "summers. "
      "<look at=\"well\"/>And <gesture name='point_far'/>there, <break time=\"400ms\"/>nothing.</p>"
      "<p><point at=\"crown\"/>Look!<view name=\"crown\"/></p></story>",
      "a");
  ASSERT_EQ(texts(script), (Texts{"He dug for three summers.", "And there, nothing.", "Look!"}));
  const StoryLine &first = script.lines[0], &second = script.lines[1], &third = script.lines[2];
  const StoryMark* emotion = find(first, StoryMarkKind::emotion);
  ASSERT_TRUE(emotion);
  EXPECT_EQ(emotion->name, "sadness");
  EXPECT_FLOAT_EQ(emotion->weight, 0.6f);
  EXPECT_EQ(emotion->at, 0u);
  ASSERT_TRUE(find(first, StoryMarkKind::beat));
  EXPECT_EQ(after(first, *find(first, StoryMarkKind::beat)), "three summers.");
  ASSERT_EQ(first.styles.size(), 1u);
  EXPECT_EQ(first.text.substr(first.styles[0].begin, first.styles[0].end - first.styles[0].begin),
            "three");
  EXPECT_EQ(first.styles[0].emphasis, 1);
  ASSERT_TRUE(find(second, StoryMarkKind::look) && find(second, StoryMarkKind::gesture));
  EXPECT_EQ(find(second, StoryMarkKind::look)->at, 0u);
  EXPECT_EQ(after(second, *find(second, StoryMarkKind::gesture)), "there, nothing.");
  ASSERT_EQ(second.styles.size(), 1u);
  EXPECT_EQ(second.text.substr(second.styles[0].begin), "nothing.");
  EXPECT_FLOAT_EQ(second.styles[0].pause, 0.4f);
  EXPECT_FLOAT_EQ(second.pause, paragraph_pause);
  ASSERT_TRUE(find(third, StoryMarkKind::point) && find(third, StoryMarkKind::view));
  EXPECT_EQ(find(third, StoryMarkKind::view)->at, third.text.size());
  EXPECT_EQ(third.pause, 0);
}

TEST(StoryScript, PiecesAreShownAsMarksSay) {
  StoryScript script = read_story(
      "<show piece='falcon' layer='inside'/>Look. It <show piece=\"falcon\" layer=\"outside\" "
      "over=\"bone\" share=\"30%\" turn=\"-90\" cut=\"0.5\"/>turns.",
      "a");
  ASSERT_EQ(texts(script), (Texts{"Look.", "It turns."}));
  const StoryMark *first = find(script.lines[0], StoryMarkKind::show),
                  *second = find(script.lines[1], StoryMarkKind::show);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->name, "falcon");
  EXPECT_EQ(first->piece.layer, "inside");
  EXPECT_EQ(first->piece.over, "");
  EXPECT_FALSE(first->piece.turn || first->piece.cut);
  EXPECT_EQ(after(script.lines[1], *second), "turns.");
  EXPECT_EQ(second->piece.over, "bone");
  EXPECT_FLOAT_EQ(second->piece.share, 0.3f);
  EXPECT_EQ(second->piece.turn, -90);
  EXPECT_EQ(second->piece.cut, 0.5f);
  for (const char* wrong :
       {"<show/>x", "<show piece='a' turn='north'/>x", "<show piece='a' turn='1000'/>x",
        "<show piece='a' cut='2'/>x", "<show piece='a' share='-1'/>x"})
    EXPECT_THROW(read_story(wrong, "a"), LoadError) << wrong;
}

TEST(StoryScript, AnEmotionAroundWordsEndsWithThem) {
  StoryScript script =
      read_story("<emotion name='joy'/>Ant. <emotion name='fear'>Bee. Cow.</emotion> Dog.", "a");
  ASSERT_EQ(script.lines.size(), 4u);
  EXPECT_EQ(script.lines[0].marks[0].name, "joy");
  EXPECT_EQ(script.lines[1].marks[0].name, "fear");
  EXPECT_TRUE(script.lines[2].marks.empty() || script.lines[2].marks[0].at == 4u);
  std::vector<StoryMark> all;
  for (const StoryLine& line : script.lines)
    for (const StoryMark& mark : line.marks) all.push_back(mark);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all.back().name, "joy");
}

TEST(StoryScript, SsmlIsUnderstood) {
  StoryScript script = read_story(R"(<?xml version="1.0"?>
<!DOCTYPE speak PUBLIC "-//W3C//DTD SYNTHESIS 1.0//EN" "x">
<speak version="1.1" xmlns="http://www.w3.org/2001/10/synthesis" xml:lang="en">
  <!-- a comment -->
  <p><s>The year was <say-as interpret-as="date">1786</say-as>.</s>
     <s><prosody rate="slow" pitch="+2st" volume="soft">Nobody</prosody> &#8211; knew. Not even he.</s></p>
  <sub alias="Saint">St</sub> Adela<mark name="here"/> said: <voice name="x">no</voice> <voice name="y">and no</voice>.
</speak>)",
                                  "a.ssml");
  EXPECT_EQ(texts(script), (Texts{"The year was 1786.", "Nobody – knew. Not even he.",
                                  "St Adela said: no and no."}));
  ASSERT_EQ(script.notes.size(), 1u);  // once
  EXPECT_NE(script.notes[0].what.find("<voice>"), std::string::npos);
  EXPECT_EQ(script.notes[0].place.line, 7);
  const SpeechStyle& slow = script.lines[1].styles.at(0);
  EXPECT_FLOAT_EQ(slow.rate, 0.8f);
  EXPECT_NEAR(slow.pitch, 1.1225f, 1e-3);
  EXPECT_FLOAT_EQ(slow.volume, 0.7f);
  EXPECT_EQ(slow.end, 6u);
  EXPECT_EQ(script.lines[2].styles.at(0).alias, "Saint");
  ASSERT_TRUE(find(script.lines[2], StoryMarkKind::mark));
  EXPECT_EQ(after(script.lines[2], *find(script.lines[2], StoryMarkKind::mark)),
            " said: no and no.");
}

TEST(StoryScript, APauseBetweenSentencesFollowsTheFirst) {
  StoryScript script =
      read_story("A dog. <break time='1.5s'/> A cat.<break strength='weak'/>", "a");
  ASSERT_EQ(script.lines.size(), 2u);
  EXPECT_FLOAT_EQ(script.lines[0].pause, 1.5f);
  EXPECT_TRUE(script.lines[0].styles.empty() && script.lines[1].styles.empty());
  EXPECT_EQ(script.lines[1].pause, 0);  // nothing follows
}

TEST(StoryScript, StylesGoOnOverSentencesAndParagraphs) {
  StoryScript script =
      read_story("<prosody rate='80%'>One two. Three.\n\nFour.</prosody> Five.", "a");
  ASSERT_EQ(script.lines.size(), 4u);
  for (size_t i = 0; i < 3; i++) {
    ASSERT_EQ(script.lines[i].styles.size(), 1u) << i;
    EXPECT_EQ(script.lines[i].styles[0].begin, 0u);
    EXPECT_EQ(script.lines[i].styles[0].end, script.lines[i].text.size());
    EXPECT_FLOAT_EQ(script.lines[i].styles[0].rate, 0.8f);
  }
  EXPECT_TRUE(script.lines[3].styles.empty());
}

TEST(StoryScript, OneLineStaysOne) {
  StoryScript script = read_story_line("Hello! Come <gesture name='invite'/>closer.", "a");
  EXPECT_EQ(texts(script), (Texts{"Hello! Come closer."}));
  EXPECT_EQ(after(script.lines[0], script.lines[0].marks.at(0)), "closer.");
}

struct Wrong {
  const char *text, *where, *what;
};

TEST(StoryScript, MistakesHaveTheirPlace) {
  for (const Wrong& wrong : std::vector<Wrong>{
           {"", "line 1, column 1", "nothing to say"},
           {"<break time='1s'/>", "line 1, column 1", "nothing to say"},
           {"One.\n  <p>Two.", "line 2, column 3", "never closed"},
           {"Är <b>x</i>", "line 1, column 8", "must be closed first"},
           {"x</p>", "line 1, column 2", "never opened"},
           {"x\n<break time='soon'/>", "line 2, column 1", "'soon' is no value for time"},
           {"x <emotion weight='1'/>", "line 1, column 3", "needs the attribute name"},
           {"x <emotion name='joy' weight='2'/>", "line 1, column 3", "weight"},
           {"x <look at=crown/>", "line 1, column 9", "quotes"},
           {"x <look at='a' at='b'/>", "line 1, column 16", "twice"},
           {"x <gesture name='nod'", "line 1, column 3", "does not end"},
           {"x <!-- y", "line 1, column 3", "a comment does not end"},
           {"ab\xff", "line 1, column 3", "not UTF-8"},
           {"<prosody rate='-5%%'>x</prosody>", "line 1, column 1", "rate"}}) {
    try {
      read_story(wrong.text, "tale.story");
      ADD_FAILURE() << wrong.text << " was taken";
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, "tale.story");
      EXPECT_EQ(error.where, wrong.where) << wrong.text;
      EXPECT_NE(error.what_.find(wrong.what), std::string::npos) << error.what_;
    }
  }
  std::string deep;
  for (int i = 0; i < 100; i++) deep += "<a>";
  EXPECT_THROW(read_story(deep + "x", "a"), LoadError);
  EXPECT_THROW(read_story("<s>" + std::string(most_line_bytes + 1, 'x') + "</s>", "a"), LoadError);
  EXPECT_THROW(read_story(std::string(most_markup_bytes + 1, ' '), "a"), LoadError);
}

// Whatever is done to a text: it is read or refused, and what is read makes sense.
TEST(StoryScript, DamagedTextsAreReadOrRefused) {
  const std::string good =
      "<speak><p><emotion name=\"joy\">A <sub alias=\"b\">c</sub>. D, <break "
      "time=\"1s\"/>e.</emotion></p>"
      "<s><prosody rate=\"90%\"><emphasis>F</emphasis> g</prosody></s><look at=\"x\"/>&amp; "
      "h.</speak>";
  Rng rng{7};
  int read = 0;
  for (int round = 0; round < 4000; round++) {
    std::string text = good;
    int changes = 1 + int(rng.uniform() * 4);
    for (int i = 0; i < changes; i++) {
      size_t at = size_t(rng.uniform() * float(text.size()));
      float dice = rng.uniform();
      if (dice < 0.4f) text.erase(at, 1 + size_t(rng.uniform() * 9));
      else if (dice < 0.7f) text.insert(at, 1, "<>/&;\"' \n.="[size_t(rng.uniform() * 11)]);
      else text.insert(at, text.substr(size_t(rng.uniform() * float(text.size())), 12));
    }
    try {
      StoryScript script = read_story(text, "a");
      read++;
      for (const StoryLine& line : script.lines) {
        ASSERT_FALSE(line.text.empty());
        for (const StoryMark& mark : line.marks) ASSERT_LE(mark.at, line.text.size());
        for (const SpeechStyle& style : line.styles) {
          ASSERT_LE(style.begin, style.end);
          ASSERT_LE(style.end, line.text.size()) << text;
        }
        Ssml ssml = make_ssml(line.text, line.styles);
        for (uint32_t byte : ssml.source) ASSERT_LE(byte, line.text.size());
      }
    } catch (const LoadError&) {}
  }
  EXPECT_GT(read, 100);
}

TEST(SpeechStyle, SsmlNamesTheByteOfEveryCharacter) {
  std::string text = "Ä <b> 12 go";
  SpeechStyle slow{3, 6, 0.8f, 1, 1, 0, "", 0}, said{7, 9, 1, 1, 1, 0, "twelve", 0}, rest;
  rest.begin = rest.end = 10;
  rest.pause = 0.25f;
  Ssml ssml = make_ssml(text, {slow, said, rest});
  EXPECT_EQ(ssml.text,
            "<speak>Ä <prosody rate=\"80%\">&lt;b&gt;</prosody> twelve <break "
            "time=\"250ms\"/>go</speak>");
  // Characters and sources go together.
  size_t character = 0;
  for (size_t i = 0; i < ssml.text.size(); i++) {
    if ((ssml.text[i] & 0xc0) == 0x80) continue;
    uint32_t byte = ssml.source.at(character++);
    if (ssml.text.substr(i, 2) == "go") {
      EXPECT_EQ(byte, 10u);
    }
    if (ssml.text.substr(i, 6) == "twelve") {
      EXPECT_EQ(byte, 7u);
    }
    if (ssml.text.substr(i, 4) == "&lt;") {
      EXPECT_EQ(byte, 3u);
    }
  }
  EXPECT_EQ(character, ssml.source.size());
}

TEST(SpeechStyle, NestedFactorsMultiplyAndNonsenseIsCut) {
  SpeechStyle half{0, 4, 0.5f}, more{2, 4, 0.5f};
  more.emphasis = 2;
  more.pitch = NAN;
  Ssml ssml = make_ssml("abcd", {half, more});
  EXPECT_EQ(ssml.text,
            "<speak><prosody rate=\"50%\">ab</prosody><prosody rate=\"30%\">"
            "<emphasis level=\"strong\">cd</emphasis></prosody></speak>");
}

TEST(StoryValue, AsSsmlWritesThem) {
  EXPECT_FLOAT_EQ(read_seconds("250ms").value(), 0.25f);
  EXPECT_FLOAT_EQ(read_seconds("+1.5s").value(), 1.5f);
  for (const char* bad : {"", "1", "-1s", "11s", "s", "nan", "1 s", "infs"})
    EXPECT_FALSE(read_seconds(bad)) << bad;
  EXPECT_FLOAT_EQ(read_rate("110%").value(), 1.1f);
  EXPECT_FLOAT_EQ(read_rate("+10%").value(), 1.1f);
  EXPECT_FLOAT_EQ(read_rate("0.9").value(), 0.9f);
  EXPECT_FLOAT_EQ(read_pitch("-12st").value(), 0.5f);
  EXPECT_NEAR(read_volume("+6dB").value(), 1.995f, 1e-3);
  for (const char* bad : {"", "x", "-200%", "0", "1e99", "2 %"})
    EXPECT_FALSE(read_rate(bad)) << bad;
  EXPECT_FLOAT_EQ(read_weight("60%").value(), 0.6f);
  EXPECT_FALSE(read_weight("1.1"));
}

}  // namespace
}  // namespace wellspring::test
