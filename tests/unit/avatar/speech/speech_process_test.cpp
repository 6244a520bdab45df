// SPDX-License-Identifier: Apache-2.0
// The voice program from outside: what it says, and what happens when it dies, hangs or lies.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "avatar/speech/process.h"
#include "avatar/speech/visemes.h"
#include "base/layers.h"
#include "unit/avatar/speech/speech_texts.h"

namespace wellspring::test {
namespace {

std::shared_ptr<const Speech> speak(SpeechProcess& process, const std::string& text,
                                    const std::string& lang = "en") {
  std::string error;
  auto speech = process.speak({.text = text, .lang = lang}, error);
  EXPECT_TRUE(speech) << error;
  return speech;
}

// A program of two lines that stands in for the voice program.
struct FakeVoice {
  std::filesystem::path path;
  explicit FakeVoice(const std::string& script) {
    std::string name =
        (std::filesystem::temp_directory_path() / "wellspring-voice-XXXXXX").string();
    int file = mkstemp(name.data());
    if (file >= 0) close(file);
    path = name;
    std::ofstream(path) << "#!/bin/sh\n" << script << "\n";
    chmod(path.c_str(), 0700);
  }
  ~FakeVoice() { std::filesystem::remove(path); }
};

constexpr const char* hello = R"(printf '\034\0\0\0\0\0\0\0{"engine":"","languages":[]}')";

TEST(SpeechProcess, EverySoundOfEveryLanguageHasAShape) {
  SpeechProcess process;
  for (const auto& [lang, text] : rich_texts()) {
    auto speech = speak(process, text, lang);
    ASSERT_TRUE(speech);
    for (const SpeechPhoneme& phoneme : speech->phonemes) {
      std::string unknown;
      mouth_shapes(phoneme.ipa, &unknown);
      EXPECT_EQ(phoneme.ipa.empty(), phoneme.word < 0) << lang << " " << phoneme.mnemonic;
      EXPECT_EQ(unknown, "") << lang << " [" << phoneme.ipa << "] " << phoneme.mnemonic;
      EXPECT_EQ(is_pause(phoneme.mnemonic), phoneme.word < 0) << lang << " " << phoneme.mnemonic;
    }
  }
}

// Numbers are said in every language's own words.
TEST(SpeechProcess, EveryLanguageThereIsHasItsShapes) {
  SpeechProcess process;
  ASSERT_TRUE(speak(process, "One."));
  std::vector<std::string> languages = process.languages();
  EXPECT_GT(languages.size(), 80u);
  for (const std::string& lang : languages) {
    auto speech = speak(process, "1 2 3 4 5 6 7 8 9 10 20 100", lang);
    ASSERT_TRUE(speech) << lang;
    for (const SpeechPhoneme& phoneme : speech->phonemes) {
      std::string unknown;
      mouth_shapes(phoneme.ipa, &unknown);
      EXPECT_EQ(unknown, "") << lang << " [" << phoneme.ipa << "] " << phoneme.mnemonic;
    }
  }
}

TEST(SpeechProcess, TimesFitTheSoundAndWordsTheText) {
  SpeechProcess process;
  auto speech = speak(process, "Of the horn, isn't it? In 1786 — “well-known”.");
  ASSERT_TRUE(speech);
  std::vector<std::string> words;
  double last = 0;
  for (const SpeechWord& word : speech->words) {
    words.push_back(speech->text.substr(word.text_begin, word.text_end - word.text_begin));
    EXPECT_GE(word.begin, last - 1e-9);
    EXPECT_GT(word.end, word.begin);
    last = word.end;
  }
  EXPECT_EQ(words, (std::vector<std::string>{"Of", "the", "horn", "isn't", "it", "In", "1786",
                                             "well-known"}));
  EXPECT_NEAR(speech->duration, double(speech->pcm.size()) / speech->rate, 1e-9);
  EXPECT_EQ(speech->phonemes.front().begin, 0);
  EXPECT_EQ(speech->phonemes.back().end, speech->duration);
  for (size_t i = 1; i < speech->phonemes.size(); i++)
    EXPECT_EQ(speech->phonemes[i].begin, speech->phonemes[i - 1].end);
}

TEST(SpeechProcess, SameSamplesWhateverWasSaidBefore) {
  SpeechProcess one, two;
  auto first = speak(one, "Good morning.");
  speak(two, "Ein anderer Satz, eine andere Sprache.", "de");
  speak(two, "Good evening, everybody!");
  auto second = speak(two, "Good morning.");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->pcm, second->pcm);
}

TEST(SpeechProcess, RequestsAreCheckedBeforeTheyAreSent) {
  SpeechProcess process;
  auto error_of = [&](SpeechRequest request) {
    std::string error;
    EXPECT_FALSE(process.speak(request, error));
    return error;
  };
  EXPECT_NE(error_of({.text = ""}).find("empty"), std::string::npos);
  EXPECT_NE(error_of({.text = std::string(1 << 20, 'a')}).find("1048576"), std::string::npos);
  for (const char* broken : {"a\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "ab\xe2\x82"})
    EXPECT_NE(error_of({.text = broken}).find("UTF-8"), std::string::npos) << broken;
  EXPECT_NE(error_of({.text = std::string("a\0b", 3)}).find("byte 1"), std::string::npos);
  EXPECT_NE(error_of({.text = "a", .lang = "../x"}).find("'../x'"), std::string::npos);
  EXPECT_NE(error_of({.text = "a", .words_per_minute = 5}).find("speed"), std::string::npos);
  EXPECT_EQ(process.process_id(), 0);
  EXPECT_NE(error_of({.text = "a", .lang = "tlh-x"}).find("tlh-x"), std::string::npos);
  EXPECT_NE(process.process_id(), 0);
  EXPECT_TRUE(speak(process, "Still there."));
}

TEST(SpeechProcess, KilledItIsStartedAgain) {
  SpeechProcess process;
  ASSERT_TRUE(speak(process, "One."));
  int before = process.process_id();
  ASSERT_GT(before, 0);
  ASSERT_EQ(kill(before, SIGKILL), 0);
  EXPECT_TRUE(speak(process, "Two."));
  EXPECT_NE(process.process_id(), before);
}

// Asked once more, the request that was under way is answered too.
TEST(SpeechProcess, KilledWhileItSpeaksItIsStartedAgain) {
  SpeechProcess process;
  ASSERT_TRUE(speak(process, "One."));
  int before = process.process_id();
  std::string text;
  while (text.size() < 9000)
    text += "The castle stands above the river, and nobody knows for whom. ";
  std::thread killer([&] {
    usleep(20000);
    kill(before, SIGKILL);
  });
  auto speech = speak(process, text);
  killer.join();
  ASSERT_TRUE(speech);
  EXPECT_GT(speech->duration, 300);
  EXPECT_NE(process.process_id(), before);
}

TEST(SpeechProcess, MissingProgramIsAnErrorAndNotTriedAtOnceAgain) {
  SpeechProcess process({.path = "/nonexistent/voice"});
  std::string first, second;
  EXPECT_FALSE(process.speak({.text = "a"}, first));
  EXPECT_FALSE(process.speak({.text = "a"}, second));
  EXPECT_NE(first.find("/nonexistent/voice"), std::string::npos);
  EXPECT_EQ(first, second);
}

TEST(SpeechProcess, ProgramsThatHangOrDieOrLieAreEnded) {
  struct Case {
    std::string script, error;
  };
  const std::vector<Case> cases = {
      {"exec sleep 60", "says nothing"},
      {"exit 3", "ends without a word"},
      {"exec yes", "ends without a word"},
      {std::string(hello) + "; exec sleep 60", "hung"},
      {std::string(hello) + "; head -c 20 >/dev/null", "died"},
      {std::string(hello) +
           R"(; head -c 20 >/dev/null; printf '\2\0\0\0\0\0\0\0[]'; exec sleep 60)",
       "no sense"},
      {std::string(hello) +
           R"(; head -c 20 >/dev/null; printf '\2\0\0\0\0\0\0\377[]'; exec sleep 60)",
       "died"},
      {R"(printf '\2\0\0\0\0\0\0\0[]'; exec sleep 60)", "another protocol"},
  };
  for (const Case& one : cases) {
    FakeVoice fake(one.script);
    SpeechProcess process({.path = fake.path, .start_seconds = 0.4, .answer_seconds = 0.4});
    std::string error;
    EXPECT_FALSE(process.speak({.text = "hello"}, error));
    EXPECT_NE(error.find(one.error), std::string::npos) << one.script << "\n" << error;
  }
}

}  // namespace
}  // namespace wellspring::test
