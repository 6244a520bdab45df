// SPDX-License-Identifier: Apache-2.0
// Recorded narration of an exhibit: found, kept, edited by hand, refused; and told in its own time.
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "avatar/speech/sound_file.h"
#include "avatar/speech/speech_json.h"
#include "base/write_file.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/storyteller/recordings.h"
#include "show/storyteller/voice.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

const char* const texts[] = {
    "The castle stands above the river, and nobody remembers who built its oldest tower.",
    "On quiet evenings you can hear the great bell from the bridge, if you hold your breath."};

struct Recordings : testing::Test {
  fs::path folder =
      fs::temp_directory_path() / ("wellspring_recordings_" + std::to_string(::getpid()));
  fs::path package = folder / "room", cache = folder / "cache";
  std::vector<Problem> problems;

  void SetUp() override {
    fs::create_directories(package);
    write(
        "scene.gltf",
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"camera":0,"name":"door"}],)"
        R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}]})");
    write_exhibit(R"({"en": "tale.wav"})", texts[0], texts[1]);
    record(texts[0], texts[1]);
  }
  void TearDown() override { fs::remove_all(folder); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(package / name) << text;
  }
  void write_exhibit(const std::string& sound, const std::string& first,
                     const std::string& second) {
    write(
        "exhibit.json",
        R"({"id":"room","title":{"en":"Room"},"scene":"scene.gltf","stories":[{"id":"tale","text":{"en":[")" +
            first + "\",\"" + second + R"("]},"sound":)" + sound + "}]}");
  }
  // Another voice reads it, with half a second between the sentences.
  void record(const std::string& first, const std::string& second) {
    SpeechProcess process;
    std::vector<int16_t> pcm(8000);
    int rate = 22050;
    for (const std::string& text : {first, second}) {
      std::string error;
      auto speech = process.speak(
          {.text = text, .lang = "en-us", .words_per_minute = 140, .variant = "f4"}, error);
      ASSERT_TRUE(speech) << error;
      pcm.insert(pcm.end(), speech->pcm.begin(), speech->pcm.end());
      pcm.resize(pcm.size() + 11025);
      rate = speech->rate;
    }
    auto wav = encode_wav(pcm, rate);
    write_file((package / "tale.wav").string(), wav);
  }
  Exhibit read() {
    problems.clear();
    Exhibit exhibit = read_exhibit(package.string(), problems);
    std::erase_if(problems, [](const Problem& problem) { return !problem.fatal; });
    if (problems.empty()) read_recordings(exhibit, {cache.string(), {}}, problems);
    return exhibit;
  }
  std::string said() const {
    std::string all;
    for (const Problem& problem : problems) all += to_string(problem) + "\n";
    return all;
  }
};

TEST_F(Recordings, AreFoundKeptAndCorrectedByHand) {
  Exhibit exhibit = read();
  ASSERT_TRUE(problems.empty()) << said();
  const auto& lines = exhibit.stories.at(0).text.at("en");
  ASSERT_EQ(lines.size(), 2u);
  for (size_t i = 0; i < 2; i++) {
    ASSERT_TRUE(lines[i].recording);
    EXPECT_EQ(lines[i].recording->text, texts[i]);
    EXPECT_FALSE(lines[i].recording->words.empty());
  }
  EXPECT_TRUE(lines_of(exhibit).empty()) << "nothing is left to be synthesised";

  // Kept: a second reading finds the same without the voice program.
  size_t kept = size_t(std::distance(fs::directory_iterator(cache), fs::directory_iterator()));
  EXPECT_EQ(kept, 1u);
  Exhibit again = read_exhibit(package.string(), problems);
  read_recordings(again, {cache.string(), {.path = "/nowhere"}}, problems);
  ASSERT_TRUE(again.stories.at(0).text.at("en")[1].recording) << said();
  double begin = lines[1].recording->words[2].begin;
  EXPECT_NEAR(again.stories.at(0).text.at("en")[1].recording->words[2].begin, begin, 1e-3);

  // By hand: the file beside the recording wins.
  auto entry = *fs::directory_iterator(cache);
  std::ifstream in(entry.path());
  Speech marks = load_speech_marks(std::string(std::istreambuf_iterator<char>(in), {}), "kept");
  size_t third = again.stories.at(0).text.at("en")[0].recording->words.size() + 2;
  marks.words[third].begin += 0.03;
  write("tale.marks.json", write_speech_json(marks));
  Exhibit edited = read();
  ASSERT_TRUE(problems.empty()) << said();
  EXPECT_NEAR(edited.stories.at(0).text.at("en")[1].recording->words[2].begin, begin + 0.03, 1e-3);

  // The text changes: marks made by hand for another text are not used silently.
  write_exhibit(R"({"en": "tale.wav"})", texts[0], "On quiet evenings you can hear it.");
  read();
  ASSERT_EQ(problems.size(), 1u) << said();
  EXPECT_TRUE(problems[0].fatal);
  EXPECT_TRUE(problems[0].file.ends_with("tale.marks.json"));
  EXPECT_EQ(problems[0].where, "/text");
}

TEST_F(Recordings, MistakesAreNamed) {
  write_exhibit(R"({"en": "other.wav"})", texts[0], texts[1]);
  read();
  ASSERT_EQ(problems.size(), 1u) << said();
  EXPECT_NE(said().find("no file 'other.wav'"), std::string::npos) << said();
  write_exhibit(R"({"de": "tale.wav"})", texts[0], texts[1]);
  read();
  EXPECT_NE(said().find("without a text"), std::string::npos) << said();
  write_exhibit(
      R"({"en": "tale.wav"})",
      "Two brothers once quarrelled about the best horse of the whole wide valley.",
      "They shouted so loudly that all of the ravens left the tower and never came back.");
  read();
  ASSERT_EQ(problems.size(), 1u) << said();
  EXPECT_TRUE(problems[0].fatal);
  EXPECT_NE(problems[0].what.find("does not say this text"), std::string::npos) << said();
  EXPECT_TRUE(problems[0].file.ends_with("tale.wav"));
  write("tale.wav", "RIFF");
  read();
  EXPECT_NE(said().find("tale.wav"), std::string::npos) << said();
}

// Its sentences take as long in the show as in the recording, pauses and all.
TEST_F(Recordings, AreToldInTheirOwnTime) {
  Exhibit exhibit = read();
  ASSERT_TRUE(problems.empty()) << said();
  Sound sound = load_sound((package / "tale.wav").string());
  Voice voice;
  tell(voice, exhibit.stories[0]);
  AskSpeech ask = [](const Utterance& utterance) {
    return SpeechState{utterance.line.at("en").recording, false, "en"};
  };
  const float step = 0.01f;
  std::vector<double> begins;  // when sentences begin to sound, seconds
  double told = 0;
  for (; !voice.queue.empty() && told < 60; told += double(step)) {
    size_t before = begins.size();
    if (voice.started && voice.elapsed >= 0 && size_t(voice.sentence) == before)
      begins.push_back(told);
    advance_voice(voice, step, ask);
  }
  double seconds = double(sound.samples.size()) / sound.rate;
  EXPECT_NEAR(told, double(speech_lead) + seconds, 0.06);
  ASSERT_EQ(begins.size(), 2u);
  const Speech& first = *exhibit.stories[0].text.at("en")[0].recording;
  EXPECT_NEAR(begins[1] - begins[0], first.duration + double(speech_lead), 0.04);
}

}  // namespace
}  // namespace wellspring::test
