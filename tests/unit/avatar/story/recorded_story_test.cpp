// SPDX-License-Identifier: Apache-2.0
// A narrator's recording of a story, whose times are known because another voice of the synthesiser
// is the narrator: marks, sentences, and what is said of a recording that is something else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "avatar/align/align.h"
#include "avatar/speech/speech_json.h"
#include "avatar/story/recorded_story.h"
#include "base/load_error.h"
#include "base/rng.h"

namespace wellspring::test {
namespace {

const char* const tale =
    "<story>The castle stands above the river. <emotion name='joy'/>Its oldest tower was built by "
    "the bishop "
    "in the longest winter. Nobody knows who paid for the great bell. On quiet evenings you can "
    "hear it "
    "from the bridge, <break time='700ms'/>if you hold your breath.</story>";

struct Narrator {
  SpeechProcess process;
  Sound recording{22050, {}};
  std::vector<SpeechWord> words;
  Rng rng{5};

  explicit Narrator(const std::vector<StoryLine>& lines) {
    pause(0.6);
    for (const StoryLine& line : lines) {
      say(line.text);
      pause(0.3 + 0.5 * double(rng.uniform()));
    }
  }
  void pause(double seconds) {
    size_t count = size_t(seconds * recording.rate);
    for (size_t i = 0; i < count; i++)
      recording.samples.push_back(0.0015f * (rng.uniform() - 0.5f));
  }
  void say(const std::string& text) {
    std::string error;
    auto speech = process.speak(
        {.text = text, .lang = "en-us", .words_per_minute = 130, .pitch = 80, .variant = "f2"},
        error);
    ASSERT_TRUE(speech) << error;
    double begin = double(recording.samples.size()) / recording.rate;
    for (SpeechWord word : speech->words) {
      word.begin += begin;
      word.end += begin;
      words.push_back(word);
    }
    for (float sample : from_pcm(speech->pcm))
      recording.samples.push_back(0.4f * sample + 0.0015f * (rng.uniform() - 0.5f));
  }
};

TEST(RecordedStory, EverySentenceGetsItsPartOfTheSound) {
  std::vector<StoryLine> lines = read_story(tale, "tale").lines;
  ASSERT_EQ(lines.size(), 4u);
  Narrator narrator(lines);
  Speech marked = mark_recording(narrator.process, lines, {}, narrator.recording);
  EXPECT_EQ(marked.text, text_of(lines));
  ASSERT_EQ(marked.words.size(), narrator.words.size());
  std::vector<double> errors;
  for (size_t i = 0; i < marked.words.size(); i++) {
    errors.push_back(std::abs(marked.words[i].begin - narrator.words[i].begin));
    errors.push_back(std::abs(marked.words[i].end - narrator.words[i].end));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LE(errors[errors.size() / 2], 0.03);
  EXPECT_GE(double(std::upper_bound(errors.begin(), errors.end(), 0.08) - errors.begin()),
            0.95 * double(errors.size()));
  EXPECT_TRUE(doubtful_places(marked, lines).empty());

  constexpr double lead = 0.2;
  auto parts = divide_recording(marked, lines, lead);
  ASSERT_EQ(parts.size(), 4u);
  double sum = lead * 3;
  size_t sample = 0, words = 0;
  for (size_t i = 0; i < parts.size(); i++) {
    const Speech& part = *parts[i];
    EXPECT_TRUE(part.recorded);
    EXPECT_EQ(part.text, lines[i].text);
    sum += part.duration;
    // The sound is a piece of the recording, after the one before, and times are times in it.
    auto at = std::search(marked.pcm.begin() + ptrdiff_t(sample), marked.pcm.end(),
                          part.pcm.begin(), part.pcm.begin() + 2000);
    ASSERT_NE(at, marked.pcm.end());
    double begin = double(at - marked.pcm.begin()) / marked.rate;
    sample = size_t(at - marked.pcm.begin()) + part.pcm.size();
    for (const SpeechWord& word : part.words) {
      EXPECT_NEAR(begin + word.begin, marked.words[words].begin, 1e-3);
      EXPECT_EQ(part.text.substr(word.text_begin, word.text_end - word.text_begin),
                marked.text.substr(marked.words[words].text_begin,
                                   marked.words[words].text_end - marked.words[words].text_begin));
      words++;
    }
    EXPECT_FALSE(part.visemes.keys.empty());
    for (const SpeechPhoneme& phoneme : part.phonemes)
      EXPECT_LT(phoneme.word, int(part.words.size()));
  }
  EXPECT_EQ(words, marked.words.size());
  EXPECT_NEAR(sum, marked.duration, 0.01) << "the narrator's own pauses, no more and no less";
}

TEST(RecordedStory, MarksMovedByHandWin) {
  std::vector<StoryLine> lines = read_story(tale, "tale").lines;
  Narrator narrator(lines);
  Speech marked = mark_recording(narrator.process, lines, {}, narrator.recording);
  Speech moved = marked;
  moved.words[1].begin += 0.05;
  Speech again = apply_marks(write_speech_json(moved), "hand", lines, narrator.recording);
  EXPECT_NEAR(again.words[1].begin, marked.words[1].begin + 0.05, 1e-3);
  EXPECT_EQ(again.pcm, marked.pcm);
  auto other = read_story("Another text.", "b").lines;
  EXPECT_THROW(apply_marks(write_speech_json(moved), "hand", other, narrator.recording), LoadError);
  Sound shorter = narrator.recording;
  shorter.samples.resize(shorter.samples.size() / 2);
  EXPECT_THROW(apply_marks(write_speech_json(moved), "hand", lines, shorter), LoadError);
}

TEST(RecordedStory, AnotherTextIsRefusedAndAnotherSentenceNoticed) {
  std::vector<StoryLine> lines = read_story(tale, "tale").lines;
  Narrator narrator(lines);
  auto other = read_story(
                   "Two brothers once quarrelled about a horse. It was the best horse of all, and "
                   "each of them "
                   "said that it was his. They shouted so loudly that the ravens left the tower.",
                   "other")
                   .lines;
  EXPECT_THROW(mark_recording(narrator.process, other, {}, narrator.recording), std::runtime_error);
  // Most of it is the same, but something long is said that the text does not have.
  Narrator more(lines);
  more.say(
      "And now I shall tell you something else, which nobody has written down anywhere, not even "
      "in this book.");
  more.pause(0.3);
  Speech marked = mark_recording(more.process, lines, {}, more.recording);
  auto notes = doubtful_places(marked, lines);
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes.back().place.line, lines.back().place.line);
}

// Twenty-four wrong pairs: with a threshold that one in ten thousand passes, a single one has a
// probability of a quarter of a percent.
TEST(SpeechFit, WrongTextsAreToldFromRightOnes) {
  const char* const texts[] = {
      "When this castle was built, there was not a drop of water on the hill, and the masons drank "
      "the rain.",
      "A young man dug for three long summers, and the others laughed at him, until they stopped "
      "laughing.",
      "The goldsmith was so afraid that he could not sleep, and at midnight he crept into the "
      "great hall.",
      "From then on they ruled together with one table, one key and one sword, and had the horse "
      "cast in bronze."};
  SpeechProcess process;
  for (const char* variant : {"f3", "m7"})
    for (size_t said = 0; said < 4; said++) {
      std::string error;
      auto sound = process.speak(
          {.text = texts[said], .lang = "en-us", .words_per_minute = 130, .variant = variant},
          error);
      ASSERT_TRUE(sound) << error;
      for (size_t read = 0; read < 4; read++) {
        auto spoken = process.speak({.text = texts[read]}, error);
        ASSERT_TRUE(spoken) << error;
        double fit = eval_fit(*spoken, {sound->rate, from_pcm(sound->pcm)});
        RecordProperty(std::string(variant) + std::to_string(said) + std::to_string(read),
                       std::to_string(fit));
        if (said == read) EXPECT_GT(fit, least_fit) << variant << said;
        else EXPECT_LT(fit, least_fit) << variant << said << read;
      }
    }
}

}  // namespace
}  // namespace wellspring::test
