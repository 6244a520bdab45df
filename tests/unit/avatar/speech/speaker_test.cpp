// SPDX-License-Identifier: Apache-2.0
// Speech for an exhibit: kept, prepared, bounded, and never waited for.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "avatar/speech/speaker.h"
#include "base/layers.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

using test::Folder;

SpeechAnswer get(const std::shared_future<SpeechAnswer>& answer) {
  if (answer.wait_for(std::chrono::seconds(30)) != std::future_status::ready)
    return {nullptr, "no answer"};
  return answer.get();
}

void wait_until_idle(const Speaker& speaker) {
  for (int i = 0; i < 3000 && speaker.counts().waiting > 0; i++) usleep(10000);
}

TEST(Speaker, WhatWasSaidIsKept) {
  Speaker speaker;
  EXPECT_FALSE(speaker.find({.text = "Hello."}));
  auto first = get(speaker.speak({.text = "Hello."}));
  ASSERT_TRUE(first.speech) << first.error;
  auto again = speaker.speak({.text = "Hello."});
  EXPECT_TRUE(is_ready(again));
  EXPECT_EQ(again.get().speech, first.speech);
  EXPECT_EQ(speaker.find({.text = "Hello."}), first.speech);
  EXPECT_FALSE(speaker.find({.text = "Hello.", .lang = "de"}));
  EXPECT_FALSE(speaker.find({.text = "Hello.", .words_per_minute = 120}));
  EXPECT_FALSE(speaker.find({.text = "Hello.", .pitch = 60}));
  EXPECT_EQ(speaker.counts().spoken, 1u);
  EXPECT_EQ(speaker.counts().from_memory, 1u);
}

TEST(Speaker, PreparedLinesAreThereWhenTheyAreNeeded) {
  Speaker speaker;
  speaker.prepare(
      {{.text = "One."}, {.text = "Zwei.", .lang = "de"}, {.text = ""}, {.text = "One."}});
  wait_until_idle(speaker);
  EXPECT_TRUE(speaker.find({.text = "One."}));
  EXPECT_TRUE(speaker.find({.text = "Zwei.", .lang = "de"}));
  EXPECT_EQ(speaker.counts().spoken, 2u);
}

TEST(Speaker, EqualRequestsUnderWayAreSaidOnce) {
  Speaker speaker;
  auto a = speaker.speak({.text = "The same line."}), b = speaker.speak({.text = "The same line."});
  EXPECT_EQ(get(a).speech, get(b).speech);
  EXPECT_EQ(speaker.counts().spoken, 1u);
}

TEST(Speaker, MemoryIsBoundedAndTheLeastUsedGoes) {
  SpeakerOptions options;
  options.memory_bytes = 400000;  // some nine seconds
  Speaker speaker(options);
  std::vector<SpeechRequest> lines;
  for (int i = 0; i < 12; i++)
    lines.push_back({.text = "This is line number " + std::to_string(i) + " of many."});
  for (const auto& line : lines) {
    ASSERT_TRUE(get(speaker.speak(line)).speech);
    EXPECT_TRUE(speaker.find(lines[0])) << "it was used all the time";
    EXPECT_LE(speaker.counts().kept_bytes, options.memory_bytes);
  }
  EXPECT_FALSE(speaker.find(lines[1]));
  EXPECT_TRUE(speaker.find(lines[11]));
  EXPECT_LT(speaker.counts().kept, 12u);
}

TEST(Speaker, AFolderOutlivesTheSpeakerAndDamageIsNoticed) {
  Folder folder;
  SpeakerOptions options;
  options.folder = (folder.path / "speech").string();
  SpeechRequest request{.text = "Kept for “tomorrow”.", .lang = "en"};
  SpeechAnswer first, second;
  {
    Speaker speaker(options);
    first = get(speaker.speak(request));
    ASSERT_TRUE(first.speech) << first.error;
  }
  {
    Speaker speaker(options);
    second = get(speaker.speak(request));
    ASSERT_TRUE(second.speech);
    EXPECT_EQ(speaker.counts().from_folder, 1u);
    EXPECT_EQ(speaker.counts().spoken, 0u);
  }
  EXPECT_EQ(first.speech->pcm, second.speech->pcm);
  ASSERT_EQ(first.speech->phonemes.size(), second.speech->phonemes.size());
  for (size_t i = 0; i < first.speech->phonemes.size(); i++)
    EXPECT_NEAR(first.speech->phonemes[i].begin, second.speech->phonemes[i].begin, 2e-4);
  for (double t = 0; t < first.speech->duration; t += 0.01)
    for (size_t v = 0; v < viseme_count; v++)
      EXPECT_NEAR(eval_visemes(first.speech->visemes, t)[v],
                  eval_visemes(second.speech->visemes, t)[v], 0.05f);
  size_t files = 0;
  for (const auto& entry : fs::directory_iterator(options.folder)) {
    files++;
    fs::resize_file(entry.path(), fs::file_size(entry.path()) - 7);
  }
  EXPECT_EQ(files, 1u);
  Speaker speaker(options);
  EXPECT_TRUE(get(speaker.speak(request)).speech);
  EXPECT_EQ(speaker.counts().spoken, 1u);
}

TEST(Speaker, WhatAnOlderVoiceProgramSpokeIsSpokenAnew) {
  Folder folder;
  SpeakerOptions options;
  options.folder = folder.path.string();
  SpeechRequest request{.text = "Spoken before the update.", .lang = "en"};
  ASSERT_TRUE(get(Speaker(options).speak(request)).speech);
  auto updated = fs::last_write_time(program_path(options.voice));
  for (const auto& entry : fs::directory_iterator(options.folder))
    fs::last_write_time(entry.path(), updated - std::chrono::seconds(1));
  Speaker speaker(options);
  EXPECT_TRUE(get(speaker.speak(request)).speech);
  EXPECT_EQ(speaker.counts().from_folder, 0u);
  EXPECT_EQ(speaker.counts().spoken, 1u);
}

TEST(Speaker, AFolderIsBounded) {
  Folder folder;
  SpeakerOptions options;
  options.folder = folder.path.string();
  options.folder_bytes = 200000;
  Speaker speaker(options);
  for (int i = 0; i < 8; i++)
    ASSERT_TRUE(get(speaker.speak({.text = "Line number " + std::to_string(i) + "."})).speech);
  uintmax_t sum = 0;
  for (const auto& entry : fs::directory_iterator(folder.path)) sum += fs::file_size(entry.path());
  EXPECT_LE(sum, options.folder_bytes);
  EXPECT_GT(sum, 0u);
}

TEST(Speaker, WithoutTheProgramEveryAnswerIsAnErrorAtOnce) {
  SpeakerOptions options;
  options.voice.path = "/nonexistent/voice";
  Speaker speaker(options);
  for (int i = 0; i < 20; i++) {
    auto answer = get(speaker.speak({.text = "Line " + std::to_string(i)}));
    EXPECT_FALSE(answer.speech);
    EXPECT_NE(answer.error.find("/nonexistent/voice"), std::string::npos);
  }
  EXPECT_EQ(speaker.counts().failed, 20u);
  auto bad = speaker.speak({.text = ""});
  ASSERT_TRUE(is_ready(bad));
  EXPECT_NE(bad.get().error.find("empty"), std::string::npos);
}

TEST(Speaker, WaitingRequestsAreBoundedAndAnsweredAtTheEnd) {
  SpeakerOptions options;
  options.most_waiting = 3;
  std::vector<std::shared_future<SpeechAnswer>> answers;
  {
    Speaker speaker(options);
    for (int i = 0; i < 50; i++)
      answers.push_back(speaker.speak({.text = "Number " + std::to_string(i)}));
    EXPECT_LE(speaker.counts().waiting, 3u);
  }
  for (const auto& answer : answers) {
    ASSERT_TRUE(is_ready(answer));
    EXPECT_EQ(answer.get().speech == nullptr, !answer.get().error.empty());
  }
}

}  // namespace
}  // namespace wellspring::test
