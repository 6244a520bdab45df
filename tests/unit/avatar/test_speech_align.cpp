// SPDX-License-Identifier: Apache-2.0
// Marks against what is known of the sound: the synthesiser's own events against energy,
// recordings whose words are known by construction, and recordings of people with word times by
// another aligner.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "avatar/speech_align.h"
#include "avatar/speech_process.h"
#include "avatar/speech_shapes.h"
#include "base/rng.h"
#include "unit/avatar/speech_texts.h"

namespace wellspring {
namespace {

Speech speak(const SpeechRequest& request) {
  SpeechProcess process;
  std::string error;
  auto speech = process.speak(request, error);
  EXPECT_TRUE(speech) << error;
  return speech ? *speech : Speech{};
}

double quantile(std::vector<double> errors, double q) {
  if (errors.empty()) return 0;
  for (double& error : errors) error = std::abs(error);
  std::sort(errors.begin(), errors.end());
  return errors[std::min(size_t(q * double(errors.size())), errors.size() - 1)];
}

double share_within(const std::vector<double>& errors, double limit) {
  double count = 0;
  for (double error : errors) count += std::abs(error) <= limit;
  return count / double(errors.size());
}

// Figures for the test's report (--gtest_output=xml).
void report(const std::vector<double>& errors) {
  ::testing::Test::RecordProperty("count", int(errors.size()));
  ::testing::Test::RecordProperty("median_ms", int(std::lround(1e3 * quantile(errors, 0.5))));
  ::testing::Test::RecordProperty("p95_ms", int(std::lround(1e3 * quantile(errors, 0.95))));
  ::testing::Test::RecordProperty("within_80_ms_percent",
                                  int(std::lround(100 * share_within(errors, 0.08))));
}

// Where sound begins after at least 100 ms of silence: the first 5 ms window that is louder than
// 40 dB under the loudest.
std::vector<double> energy_onsets(const Speech& speech) {
  size_t window = size_t(speech.rate / 200);
  std::vector<double> energy, onsets;
  for (size_t i = 0; i + window <= speech.pcm.size(); i += window) {
    double sum = 0;
    for (size_t k = i; k < i + window; k++) sum += double(speech.pcm[k]) * double(speech.pcm[k]);
    energy.push_back(sum);
  }
  double threshold = *std::max_element(energy.begin(), energy.end()) * 1e-4;
  size_t quiet = 1000;
  for (size_t i = 0; i < energy.size(); i++) {
    if (energy[i] > threshold) {
      if (quiet >= 20) onsets.push_back(double(i * window) / speech.rate);
      quiet = 0;
    } else {
      quiet++;
    }
  }
  return onsets;
}

// Voiceless stops begin with silence, so their onset is their burst: texts without them at the
// start.
TEST(SpeechMarks, SynthesisBeginsWhereItSaysSo) {
  const std::vector<SpeechText> texts = {
      {"en",
       "Many. Will. Some. Eight. Over. Low. Are. Never. Red. You. Moon. Sea. Vast. All. Lamp."},
      {"de", "Mehr. Wasser. Sonne. Acht. Ober. Licht. Nie. Rot. Ja. Mond. See. Alle. Lampe. Uhr."},
      {"sk", "More. Voda. Soľ. Osem. Oblak. Les. Ruka. Jeseň. Mesiac. Zima. Lampa. Ulica. Nos."},
      {"fr", "Mer. Vent. Soleil. Huit. Or. Lune. Rue. Jour. Nuit. Ami. Lampe. Île. Zone."},
      {"es", "Mar. Viento. Sol. Ocho. Oro. Luna. Rey. Noche. Amigo. Isla. Uno. Era. Mesa."}};
  std::vector<double> errors;
  for (const auto& [lang, text] : texts) {
    Speech speech = speak({.text = text, .lang = lang});
    std::vector<double> onsets = energy_onsets(speech);
    ASSERT_GE(onsets.size(), 10u) << lang;
    for (double onset : onsets) {
      double nearest = 1;
      for (size_t i = 0; i < speech.phonemes.size(); i++)
        if (!is_pause(speech.phonemes[i].mnemonic) &&
            (i == 0 || is_pause(speech.phonemes[i - 1].mnemonic))) {
          double error = speech.phonemes[i].begin - onset;
          if (std::abs(error) < std::abs(nearest)) nearest = error;
        }
      errors.push_back(nearest);
    }
  }
  EXPECT_LE(quantile(errors, 0.5), 0.03);
  EXPECT_GE(share_within(errors, 0.08), 0.95);
  report(errors);
}

// Somebody else with other pauses, another pace and a hissing microphone, whose times are known.
struct Narrated {
  Sound recording;
  std::vector<SpeechWord> words;
};

Narrated narrate(const std::vector<std::string>& sentences, const SpeechRequest& manner) {
  Narrated narrated;
  narrated.recording.rate = 22050;
  Rng rng{5};
  auto& samples = narrated.recording.samples;
  auto pause = [&](double seconds) { samples.resize(samples.size() + size_t(seconds * 22050)); };
  pause(0.8);
  for (const std::string& sentence : sentences) {
    SpeechRequest request = manner;
    request.text = sentence;
    Speech speech = speak(request);
    double offset = double(samples.size()) / 22050;
    for (SpeechWord word : speech.words) {
      word.begin += offset;
      word.end += offset;
      narrated.words.push_back(word);
    }
    std::vector<float> sound = from_pcm(speech.pcm);
    samples.insert(samples.end(), sound.begin(), sound.end());
    pause(0.2 + double(rng.uniform()));
  }
  for (float& sample : samples) sample = 0.4f * sample + 0.003f * (rng.uniform() - 0.5f);
  return narrated;
}

TEST(SpeechMarks, ARecordingByAnotherVoiceIsAligned) {
  const std::vector<std::string> sentences = {"The castle stands above the river.",
                                              "Its oldest tower was built by the bishop in winter.",
                                              "Nobody knows who paid for the great bell.",
                                              "On quiet evenings you can hear it from the bridge."};
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + " ";
  Narrated narrated =
      narrate(sentences, {.text = "", .lang = "en-us", .words_per_minute = 125, .pitch = 85});
  Speech spoken = speak({.text = text});
  double pace = measure_pace(spoken, narrated.recording);
  EXPECT_GT(pace, 1.05);
  EXPECT_LT(pace, 1.6);
  Speech speech = align_speech(spoken, narrated.recording);
  ASSERT_EQ(speech.words.size(), narrated.words.size());
  std::vector<double> errors;
  for (size_t i = 0; i < speech.words.size(); i++) {
    errors.push_back(speech.words[i].begin - narrated.words[i].begin);
    errors.push_back(speech.words[i].end - narrated.words[i].end);
  }
  EXPECT_LE(quantile(errors, 0.5), 0.03);
  EXPECT_GE(share_within(errors, 0.08), 0.95);
  report(errors);
  EXPECT_EQ(speech.phonemes.front().begin, 0);
  EXPECT_EQ(speech.phonemes.back().end, speech.duration);
  for (size_t i = 1; i < speech.phonemes.size(); i++)
    EXPECT_NEAR(speech.phonemes[i].begin, speech.phonemes[i - 1].end, 1e-3);
}

TEST(SpeechMarks, NothingToAlignIsSaid) {
  Speech spoken =
      speak({.text = "A rather long sentence for a very short recording of it, is it not?"});
  Sound silence{16000, std::vector<float>(32000)}, blip{16000, {}};
  for (int i = 0; i < 3000; i++) blip.samples.push_back(0.3f * std::sin(float(i) * 0.3f));
  EXPECT_THROW(align_speech(spoken, silence), std::runtime_error);
  EXPECT_THROW(align_speech(spoken, blip), std::runtime_error);
  // Any other sound gives some marks, all within it.
  Sound noise{8000, {}};
  Rng rng{1};
  for (int i = 0; i < 60000; i++) noise.samples.push_back(rng.uniform() - 0.5f);
  Speech speech = align_speech(spoken, noise);
  for (const SpeechWord& word : speech.words) {
    EXPECT_GE(word.begin, 0);
    EXPECT_LE(word.begin, word.end);
    EXPECT_LE(word.end, speech.duration);
  }
}

// Word times of people by the Gentle aligner (10 ms steps). Its transcript marks what it found; of
// those, words in runs of three or more whose phones all last under 0.45 s are taken as true.
struct Reference {
  size_t character = 0;
  double begin = 0, end = 0;
};

std::vector<Reference> read_reference(const std::string& file) {
  auto json = nlohmann::json::parse(std::ifstream(file));
  std::vector<Reference> all, run;
  auto close = [&] {
    if (run.size() >= 3) all.insert(all.end(), run.begin(), run.end());
    run.clear();
  };
  for (const auto& token : json.contains("tokens") ? json["tokens"] : json["words"]) {
    bool good = token.at("case") == "success";
    if (good)
      for (const auto& phone : token.at("phones"))
        good &= phone.at("duration").get<double>() <= 0.45;
    if (!good) {
      close();
      continue;
    }
    run.push_back({token.at("startOffset").get<size_t>(), token.at("start").get<double>(),
                   token.at("end").get<double>()});
  }
  close();
  return all;
}

Speech align_file(const std::string& text, const std::string& file) {
  Sound recording = load_sound(file);
  SpeechRequest request{.text = text};
  Speech spoken = speak(request);
  double pace = measure_pace(spoken, recording);
  request.words_per_minute = int(std::clamp(request.words_per_minute / pace, 80.0, 450.0));
  return align_speech(speak(request), recording);
}

class SpeechCorpus : public ::testing::Test {
 protected:
  const std::string folder = std::string(WELLSPRING_DATA) + "/9_speech/gentle/";
  void SetUp() override {
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings in " << folder;
  }
};

// A hundred seconds of an old tape: hiss, hum, room, and a speaker who stutters, so that the text
// does not say all that is heard. Not within the 30 ms and 95 % wished for; this is what is
// reached.
TEST_F(SpeechCorpus, AStutteringNarratorOnTape) {
  auto reference = read_reference(folder + "lucier_golden.json");
  auto json = nlohmann::json::parse(std::ifstream(folder + "lucier_golden.json"));
  Speech speech = align_file(json["transcript"].get<std::string>(), folder + "lucier.mp3");
  std::map<size_t, SpeechWord> by_place;
  for (const SpeechWord& word : speech.words) by_place[word.text_begin] = word;
  std::vector<double> errors;
  for (const Reference& word : reference) {
    ASSERT_TRUE(by_place.contains(word.character));
    errors.push_back(by_place[word.character].begin - word.begin);
    errors.push_back(by_place[word.character].end - word.end);
  }
  report(errors);
  ASSERT_GE(errors.size(), 140u);
  EXPECT_LE(quantile(errors, 0.5), 0.04);
  EXPECT_GE(share_within(errors, 0.08), 0.75);
  EXPECT_GE(share_within(errors, 0.25), 0.88);
}

// Telephone quality, four seconds. The reference heard other words than were said from the seventh
// on.
TEST_F(SpeechCorpus, ASentenceByTelephone) {
  auto json =
      nlohmann::json::parse(std::ifstream(folder + "full-harvard-sentences-list30-s01.json"));
  Speech speech = align_file("The mute muffled the high tones of the horn.",
                             folder + "harvard-sentences-list30-s01.mp3");
  ASSERT_EQ(speech.words.size(), 9u);
  std::vector<double> errors;
  for (size_t i = 0; i < 6; i++)
    errors.push_back(speech.words[i].begin - json["words"][i]["start"].get<double>());
  report(errors);
  EXPECT_LE(quantile(errors, 0.5), 0.06);
  EXPECT_GE(share_within(errors, 0.08), 0.95);
}

}  // namespace
}  // namespace wellspring
