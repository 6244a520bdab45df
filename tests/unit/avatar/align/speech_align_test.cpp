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

#include "avatar/align/align.h"
#include "avatar/speech/process.h"
#include "avatar/speech/visemes.h"
#include "base/rng.h"
#include "unit/avatar/speech/narrator.h"
#include "unit/avatar/speech/speech_texts.h"

namespace wellspring::test {
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

// Returns when sound begins after at least 100 ms of silence: the first 5 ms window that is louder
// than 40 dB under the loudest.
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

std::vector<double> errors_of(const Speech& speech, const Narrated& narrated) {
  std::vector<double> errors;
  for (size_t i = 0; i < speech.words.size(); i++) {
    errors.push_back(speech.words[i].begin - narrated.words[i].begin);
    errors.push_back(speech.words[i].end - narrated.words[i].end);
  }
  return errors;
}

// Aligns at the narrator's own pace.
Speech align(SpeechProcess& process, const std::string& text, const std::string& lang,
             const Sound& recording) {
  std::string error;
  SpeechRequest request{.text = text, .lang = lang};
  auto spoken = process.speak(request, error);
  if (!spoken) throw std::runtime_error(error);
  double pace = measure_pace(*spoken, recording);
  request.words_per_minute = int(std::clamp(request.words_per_minute / pace, 80.0, 450.0));
  return align_speech(*process.speak(request, error), recording);
}

TEST(SpeechMarks, ARecordingByAnotherVoiceIsAligned) {
  const std::string text =
      "The castle stands above the river. Its oldest tower was built by the bishop in "
      "winter. Nobody knows who paid for the great bell. On quiet evenings you can hear "
      "it from the bridge.";
  SpeechProcess process;
  Narrated narrated =
      narrate(process, {.text = text, .lang = "en-us", .words_per_minute = 125, .pitch = 85},
              {.pause = 0.15f, .hiss = 0.001f});
  Speech spoken = speak({.text = text});
  double pace = measure_pace(spoken, narrated.recording);
  EXPECT_GT(pace, 1.05);
  EXPECT_LT(pace, 1.6);
  Speech speech = align_speech(spoken, narrated.recording);
  ASSERT_EQ(speech.words.size(), narrated.words.size());
  std::vector<double> errors = errors_of(speech, narrated);
  EXPECT_LE(quantile(errors, 0.5), 0.03);
  EXPECT_GE(share_within(errors, 0.08), 0.95);
  report(errors);
  EXPECT_EQ(speech.phonemes.front().begin, 0);
  EXPECT_EQ(speech.phonemes.back().end, speech.duration);
  for (size_t i = 1; i < speech.phonemes.size(); i++)
    EXPECT_NEAR(speech.phonemes[i].begin, speech.phonemes[i - 1].end, 1e-3);
}

// Speakers who repeat the beginnings of words and whole words, drag sounds out, fall silent within
// words, say what is not in the text and breathe, on a tape that clicks, in rooms, by telephone.
struct StutterCase {
  std::string lang, voice, variant, text;
  double room = 0;
  int rate = 22050;
};

const std::vector<StutterCase>& stutter_cases() {
  static const std::vector<StutterCase> cases = {
      {"en", "en-us", "klatt2",
       "The castle stands above the river, where merchants once paid their toll in "
       "silver. Its oldest tower was built by the bishop in the winter of a hungry year. Nobody "
       "knows who paid "
       "for the great bell, but on quiet evenings you can hear it from the bridge.",
       0.35},
      {"de", "de", "m7",
       "Die Burg steht hoch über dem Fluss, wo die Händler einst ihren Zoll bezahlten. Der "
       "älteste Turm wurde vom Bischof in einem harten Winter erbaut. Niemand weiß, wer die große "
       "Glocke "
       "gestiftet hat, aber an stillen Abenden hört man sie von der Brücke."},
      {"sk", "sk", "croak",
       "Hrad stojí vysoko nad riekou, kde kupci kedysi platili mýto. Najstaršiu vežu dal "
       "postaviť biskup počas tuhej zimy. Nikto nevie, kto zaplatil veľký zvon.",
       0, 8000},
      {"fr", "fr", "klatt2",
       "Le château se dresse au-dessus de la rivière, où les marchands payaient autrefois "
       "leur péage. La plus vieille tour fut bâtie par l'évêque pendant un hiver très dur.",
       0.35},
      {"es", "es", "m7",
       "El castillo está sobre el río, donde los mercaderes pagaban su peaje. La torre más "
       "antigua fue construida por el obispo en un invierno muy duro."}};
  return cases;
}

TEST(SpeechMarks, StutteringNarratorsAreAligned) {
  const Manner stutter{.pause = 0.08f,
                       .repeat = 0.08f,
                       .again = 0.03f,
                       .prolong = 0.08f,
                       .block = 0.04f,
                       .filler = 0.03f,
                       .breath = 0.15f,
                       .clicks = 0.5f,
                       .hiss = 0.002f};
  SpeechProcess process;
  std::vector<double> errors;
  for (const StutterCase& narrator : stutter_cases())
    for (uint64_t seed : {1, 2}) {
      Manner manner = stutter;
      manner.room = narrator.room;
      manner.rate = narrator.rate;
      manner.seed = seed;
      Narrated narrated = narrate(process,
                                  {.text = narrator.text,
                                   .lang = narrator.voice,
                                   .words_per_minute = 150,
                                   .variant = narrator.variant},
                                  manner);
      Speech speech = align(process, narrator.text, narrator.lang, narrated.recording);
      ASSERT_EQ(speech.words.size(), narrated.words.size()) << narrator.lang;
      auto own = errors_of(speech, narrated);
      EXPECT_LE(quantile(own, 0.5), 0.03) << narrator.lang << " " << seed;
      errors.insert(errors.end(), own.begin(), own.end());
    }
  report(errors);
  EXPECT_GE(errors.size(), 500u);
  EXPECT_LE(quantile(errors, 0.5), 0.015);
  EXPECT_GE(share_within(errors, 0.08), 0.95);
}

// A narrator says the beginnings of some words twice; whenever he is heard, his mouth moves.
TEST(SpeechMarks, LipsStutterWithTheirNarrator) {
  const std::string text =
      "The castle stands above the river, where merchants once paid their toll in silver. "
      "Nobody knows who paid for the great bell, but children hear it from the bridge.";
  SpeechProcess process;
  Narrated narrated = narrate(process, {.text = text, .lang = "en-us", .variant = "m7"},
                              {.repeat = 0.3f, .hiss = 0.0005f, .seed = 4});
  Speech speech = align(process, text, "en", narrated.recording);
  double heard = 0, still = 0, repeated = 0;
  size_t window = size_t(speech.rate / 100), phoneme = 0;
  for (size_t i = 0; i + window < speech.pcm.size(); i += window) {
    double sum = 0, middle = (double(i) + 0.5 * double(window)) / speech.rate;
    for (size_t k = i; k < i + window; k++) sum += std::pow(double(speech.pcm[k]) / 32768, 2);
    while (phoneme + 1 < speech.phonemes.size() && speech.phonemes[phoneme].end <= middle)
      phoneme++;
    const SpeechPhoneme& now = speech.phonemes[phoneme];
    repeated += !is_pause(now.mnemonic) && now.word < 0;
    if (sum / double(window) < 1e-4) continue;
    heard++;
    still += is_pause(now.mnemonic);
  }
  EXPECT_GT(repeated, heard / 20);
  EXPECT_LT(still, heard / 20) << heard << " windows";
  for (size_t i = 1; i < speech.phonemes.size(); i++) {
    EXPECT_GE(speech.phonemes[i].begin, speech.phonemes[i - 1].end - 1e-9);
    EXPECT_GE(speech.phonemes[i].end, speech.phonemes[i].begin);
  }
}

// The lips of a p are shut while nothing is heard, before it bursts.
TEST(SpeechMarks, ClosuresBelongToTheirStops) {
  for (const SpeechText& text :
       {SpeechText{"en", "A happy copper pepper, a pocket of paper and a cap too."},
        SpeechText{"sk", "Opica kope do papiera a pakuje topánky."},
        SpeechText{"es", "La capa del poeta tapa la copa."}}) {
    Speech speech = speak({.text = text.text, .lang = text.lang});
    double peak = 0;
    for (int16_t x : speech.pcm) peak = std::max(peak, std::abs(double(x)));
    int stops = 0, silent = 0, before = 0;
    auto quiet = [&](double begin, double end) {
      double most = 0;
      for (size_t i = size_t(begin * speech.rate);
           i < size_t(end * speech.rate) && i < speech.pcm.size(); i++)
        most = std::max(most, std::abs(double(speech.pcm[i])));
      return most < 0.02 * peak;
    };
    for (size_t i = 1; i < speech.phonemes.size(); i++) {
      const SpeechPhoneme &stop = speech.phonemes[i], &last = speech.phonemes[i - 1];
      bool voiceless =
          stop.ipa.starts_with("p") || stop.ipa.starts_with("t") || stop.ipa.starts_with("k");
      EXPECT_GE(stop.begin, last.begin);
      EXPECT_EQ(stop.begin, last.end);
      if (!voiceless || is_pause(last.mnemonic) || stop.end - stop.begin < 0.03) continue;
      stops++;
      silent += quiet(stop.begin + 0.003, stop.begin + 0.018);
      before += quiet(last.end - 0.015, last.end);
    }
    EXPECT_GE(stops, 6) << text.lang;
    EXPECT_GE(silent, stops * 2 / 3) << text.lang << " of " << stops;
    EXPECT_LE(before, stops / 4) << text.lang << " of " << stops;
  }
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
  SpeechProcess process;
  return align(process, text, "en", load_sound(file));
}

class SpeechCorpus : public ::testing::Test {
 protected:
  const std::string folder = std::string(WELLSPRING_DATA) + "/9_speech/gentle/";
  void SetUp() override {
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings in " << folder;
  }
};

// A hundred seconds of an old tape: hiss, hum, room, and a speaker who stutters, so that the text
// does not say all that is heard. Nothing is chosen by it. 95 % within 80 ms are wished for; this
// is what is reached, where the reference itself is not always right.
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
  EXPECT_LE(quantile(errors, 0.5), 0.03);
  EXPECT_GE(share_within(errors, 0.08), 0.82);
  EXPECT_GE(share_within(errors, 0.25), 0.95);
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
  EXPECT_LE(quantile(errors, 0.5), 0.05);
  EXPECT_GE(share_within(errors, 0.08), 0.95);
}

}  // namespace
}  // namespace wellspring::test
