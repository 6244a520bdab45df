// SPDX-License-Identifier: Apache-2.0
// Sound files and marks: written and read back, edited, damaged.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "avatar/speech/speech_json.h"
#include "avatar/speech/process.h"
#include "avatar/speech/sound_file.h"
#include "base/load_error.h"
#include "base/rng.h"
#include "base/write_file.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

using test::Folder;

std::string error_of(const std::string& file) {
  try {
    load_sound(file);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, file);
    return error.what_;
  }
  return "";
}

TEST(SpeechSound, WavRoundTripIsExact) {
  Folder folder;
  std::vector<int16_t> pcm;
  Rng rng{1};
  for (int i = 0; i < 5000; i++) pcm.push_back(int16_t(int(rng.next() % 65536) - 32768));
  auto wav = encode_wav(pcm, 22050);
  write_file(folder.file("a.wav"), wav);
  Sound sound = load_sound(folder.file("a.wav"));
  EXPECT_EQ(sound.rate, 22050);
  EXPECT_EQ(sound.samples, from_pcm(pcm));
}

TEST(SpeechSound, BadFilesAreRefusedByName) {
  Folder folder;
  std::string wav;
  for (uint8_t byte : encode_wav(std::vector<int16_t>(1000), 22050)) wav += char(byte);
  EXPECT_NE(error_of(folder.file("none.wav")).find("no such file"), std::string::npos);
  EXPECT_NE(error_of(folder.path.string()).find("regular"), std::string::npos);
  EXPECT_NE(error_of(folder.write("empty.wav", "")), "");
  EXPECT_NE(error_of(folder.write("text.wav", "this is no sound")), "");
  EXPECT_NE(error_of(folder.write("header.wav", wav.substr(0, 44))), "");
  std::string rate = wav;
  rate.replace(24, 4, std::string("\x01\0\0\0", 4));
  EXPECT_NE(error_of(folder.write("rate.wav", rate)).find("rate of 1 Hz"), std::string::npos);
  ASSERT_EQ(mkfifo(folder.file("pipe.wav").c_str(), 0600), 0);
  EXPECT_NE(error_of(folder.file("pipe.wav")).find("regular"), std::string::npos);
}

TEST(SpeechSound, DamagedFilesNeverCrash) {
  Folder folder;
  std::string wav;
  for (uint8_t byte : encode_wav(std::vector<int16_t>(1000), 22050)) wav += char(byte);
  Rng rng{3};
  for (int i = 0; i < 300; i++) {
    std::string damaged = wav.substr(0, 20 + rng.next() % (wav.size() - 20));
    for (int k = 0; k < 4; k++)
      damaged[rng.next() % std::min<size_t>(damaged.size(), 48)] = char(rng.next());
    std::string file = folder.write("damaged.wav", damaged);
    try {
      Sound sound = load_sound(file);
      EXPECT_LE(sound.samples.size(), damaged.size());
    } catch (const LoadError&) {}
  }
}

TEST(SpeechSound, TooLongIsRefusedWithoutReadingAllOfIt) {
  Folder folder;
  std::string file = folder.file("long.wav");
  auto wav = encode_wav(std::vector<int16_t>(8), 4000);
  uint32_t bytes = 4000u * 2 * 100000;
  for (int i = 0; i < 4; i++) {
    wav[size_t(40 + i)] = uint8_t(bytes >> (8 * i));
    wav[size_t(4 + i)] = uint8_t((bytes + 36) >> (8 * i));
  }
  write_file(file, wav);
  fs::resize_file(file, 44 + bytes);  // sparse
  EXPECT_NE(error_of(file).find("longer than"), std::string::npos);
}

TEST(SpeechSound, ResamplingKeepsATone) {
  for (auto [from, to] : {std::pair{22050, 16000}, {8000, 16000}, {44100, 16000}, {48000, 22050}}) {
    std::vector<float> tone;
    for (int i = 0; i < from; i++)
      tone.push_back(std::sin(float(2 * std::numbers::pi * 1000 * i / from)));
    std::vector<float> other = resample(tone, from, to);
    EXPECT_NEAR(double(other.size()), to, 1);
    for (int i = to / 4; i < to * 3 / 4; i++)
      ASSERT_NEAR(other[size_t(i)], std::sin(2 * std::numbers::pi * 1000 * i / to), 0.01)
          << from << " to " << to;
  }
  // Frequencies that the lower rate cannot hold are gone.
  std::vector<float> high;
  for (int i = 0; i < 44100; i++)
    high.push_back(std::sin(float(2 * std::numbers::pi * 12000 * i / 44100)));
  std::vector<float> low = resample(high, 44100, 16000);
  for (size_t i = 100; i + 100 < low.size(); i++) ASSERT_LT(std::abs(low[i]), 0.02f);
}

Speech make_marks() {
  Speech speech;
  speech.text = "Žltý kôň";
  speech.lang = "sk";
  speech.duration = 1.5;
  speech.words = {{0.1, 0.5, 0, 6}, {0.7, 1.2, 7, 12}};
  speech.phonemes = {{0, 0.1, "_:", "", -1},   {0.1, 0.2, "Z", "ʒ", 0}, {0.2, 0.5, "i", "i", 0},
                     {0.5, 0.7, "_:", "", -1}, {0.7, 0.9, "k", "k", 1}, {0.9, 1.2, "o", "o", 1},
                     {1.2, 1.5, "_:", "", -1}};
  fill_visemes(speech);
  return speech;
}

TEST(SpeechMarksFile, RoundTrip) {
  Speech speech = make_marks();
  std::string json = write_speech_json(speech);
  Speech again = load_speech_marks(json, "a.json");
  EXPECT_EQ(write_speech_json(again), json);
  EXPECT_EQ(again.words[1].text_begin, 7u);
}

TEST(SpeechMarksFile, MovedWordsTakeTheirPhonemesAlong) {
  std::string json = write_speech_json(make_marks());
  auto replace = [&](const std::string& from, const std::string& to) {
    size_t at = json.find(from);
    ASSERT_NE(at, std::string::npos) << from << json;
    json.replace(at, from.size(), to);
  };
  replace(R"("start":0.7,"end":1.2,"char)", R"("start":0.8,"end":1.3,"char)");
  Speech speech = load_speech_marks(json, "a.json");
  EXPECT_DOUBLE_EQ(speech.words[1].begin, 0.8);
  ASSERT_EQ(speech.phonemes.size(), 7u);
  EXPECT_EQ(speech.phonemes[3].word, -1);
  EXPECT_NEAR(speech.phonemes[3].end, 0.8, 1e-9);
  EXPECT_NEAR(speech.phonemes[4].begin, 0.8, 1e-9);
  EXPECT_NEAR(speech.phonemes[4].end, 1.0, 1e-9);
  EXPECT_NEAR(speech.phonemes[5].end, 1.3, 1e-9);
  EXPECT_GT(eval_visemes(speech.visemes, 1.15)[size_t(Viseme::oh)], 0.9f);
}

// "Žltý k- kôň": what is said in vain stays where it was, as far as its neighbours leave it room.
TEST(SpeechMarksFile, SoundsOfNoWordKeepTheirTimes) {
  Speech speech = make_marks();
  speech.phonemes[3] = {0.55, 0.65, "k", "k", -1};
  fit_phonemes(speech);
  fill_visemes(speech);
  ASSERT_EQ(speech.phonemes.size(), 9u);  // with pauses before and after it
  std::string json = write_speech_json(speech);
  Speech again = load_speech_marks(json, "a.json");
  EXPECT_EQ(write_speech_json(again), json);
  EXPECT_EQ(again.phonemes[4].mnemonic, "k");
  EXPECT_DOUBLE_EQ(again.phonemes[4].begin, 0.55);
  EXPECT_DOUBLE_EQ(again.phonemes[4].end, 0.65);

  again.words[1].begin = 0.6;  // moved over half of it
  fit_phonemes(again);
  EXPECT_DOUBLE_EQ(again.phonemes[4].end, 0.6);
  again.words[1].begin = 0.555;  // too little is left of it
  fit_phonemes(again);
  EXPECT_EQ(again.phonemes[4].word, 1);
  EXPECT_EQ(again.phonemes.size(), 7u);
}

TEST(SpeechMarksFile, MistakesAreNamedByPlace) {
  const std::string good = write_speech_json(make_marks());
  auto place_of = [&](const std::string& from, const std::string& to) {
    std::string json = good;
    size_t at = json.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    json.replace(at, from.size(), to);
    try {
      load_speech_marks(json, "a.json");
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, "a.json");
      return error.where;
    }
    return std::string("accepted");
  };
  EXPECT_EQ(place_of(R"("version": 1)", R"("version": 2)"), "/version");
  EXPECT_EQ(place_of(R"("start":0.7,"end":1.2,"ch)", R"("start":0.3,"end":1.2,"ch)"),
            "/words/1/start");
  EXPECT_EQ(place_of(R"("start":0.7,"end":1.2,"ch)", R"("start":0.7,"end":0.6,"ch)"),
            "/words/1/end");
  EXPECT_EQ(place_of(R"("start":0.7,"end":1.2,"ch)", R"("start":0.7,"end":9,"ch)"), "/words/1/end");
  EXPECT_EQ(place_of(R"("start":0.7,"end":1.2,"ch)", R"("start":"x","end":1.2,"ch)"),
            "/words/1/start");
  EXPECT_EQ(place_of(R"("characters":[5,8])", R"("characters":[5,80])"), "/words/1/characters/1");
  EXPECT_EQ(place_of(R"("characters":[5,8])", R"("characters":[-5,8])"), "/words/1/characters/0");
  EXPECT_EQ(place_of(R"("word":1)", R"("word":2)"), "/phonemes/4/word");
  EXPECT_EQ(place_of(R"("word":1)", R"("word":0.5)"), "/phonemes/4/word");
  EXPECT_EQ(place_of(R"("ipa":"k")", R"("ipa":7)"), "/phonemes/4/ipa");
  EXPECT_EQ(place_of(R"("duration": 1.5)", R"("duration": 1e300)"), "/duration");
  EXPECT_EQ(place_of(R"("lang")", R"("tongue")"), "/lang");
  EXPECT_THROW(load_speech_marks("{", "a.json"), LoadError);
  EXPECT_THROW(load_speech_marks(std::string(100000, '['), "a.json"), LoadError);
}

TEST(SpeechMarksFile, DamagedMarksNeverCrash) {
  const std::string good = write_speech_json(make_marks());
  Rng rng{8};
  for (int i = 0; i < 2000; i++) {
    std::string json = good;
    for (int k = 0; k < 3; k++)
      json[rng.next() % json.size()] = "0123456789-,:[]{}\"ex"[rng.next() % 20];
    try {
      Speech speech = load_speech_marks(json, "a.json");
      for (const SpeechPhoneme& phoneme : speech.phonemes) {
        ASSERT_LE(phoneme.begin, phoneme.end);
        ASSERT_LE(phoneme.end, speech.duration + 1e-9);
        ASSERT_GE(phoneme.begin, 0);
      }
    } catch (const LoadError&) {}
  }
}

}  // namespace
}  // namespace wellspring::test
