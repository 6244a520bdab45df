// SPDX-License-Identifier: Apache-2.0
// The mouth's laws: weights in [0, 1] with sum 1, closures that close, no corners, no memory.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "avatar/speech/visemes.h"
#include "base/rng.h"

namespace wellspring::test {
namespace {

float at(const VisemeWeights& weights, Viseme viseme) { return weights[size_t(viseme)]; }

// One sound of `seconds` after the other, from IPA; "_" is a pause.
std::vector<MouthSound> sounds_of(const std::vector<std::pair<std::string, double>>& list) {
  std::vector<MouthSound> sounds;
  double time = 0;
  for (const auto& [ipa, seconds] : list) {
    sounds.push_back({time, time + seconds, mouth_shapes(ipa == "_" ? "" : ipa), ipa == "_"});
    time += seconds;
  }
  return sounds;
}

std::vector<MouthSound> random_sounds(Rng& rng, int count) {
  const std::vector<std::string> names = {"p",  "b", "m",  "f",   "v",  "θ",  "t", "k",
                                          "tʃ", "s", "n",  "ɹ",   "a",  "e",  "ə", "i",
                                          "ɔ",  "u", "aɪ", "aʊə", "ts", "pf", "h", "_"};
  std::vector<std::pair<std::string, double>> list;
  for (int i = 0; i < count; i++) {
    size_t pick = std::min(size_t(rng.uniform() * float(names.size())), names.size() - 1);
    double u = double(rng.uniform());
    list.push_back({names[pick], u < 0.05 ? 0 : 0.3 * u * u});
  }
  return sounds_of(list);
}

TEST(SpeechVisemes, EachSoundHasItsShape) {
  const std::vector<std::pair<std::string, std::vector<Viseme>>> cases = {
      {"m", {Viseme::PP}},
      {"v", {Viseme::FF}},
      {"ð", {Viseme::TH}},
      {"ɾ", {Viseme::DD}},
      {"ʁ", {Viseme::kk}},
      {"tʃ", {Viseme::CH}},
      {"dʒ", {Viseme::CH}},
      {"z", {Viseme::SS}},
      {"ŋ", {Viseme::nn}},
      {"ɹ", {Viseme::RR}},
      {"ɑː", {Viseme::aa}},
      {"ɛ", {Viseme::E}},
      {"iː", {Viseme::ih}},
      {"œ", {Viseme::oh}},
      {"yː", {Viseme::ou}},
      {"l̩", {Viseme::nn}},
      {"ɔ̃", {Viseme::oh}},
      {"t͡s", {Viseme::DD, Viseme::SS}},
      {"h", {}},
      {"ʔ", {}},
      {"pf", {Viseme::PP, Viseme::FF}},
      {"aɪ", {Viseme::aa, Viseme::ih}},
      {"əʊ", {Viseme::E, Viseme::ou}},
      {"aɪə", {Viseme::aa, Viseme::ih, Viseme::E}}};
  for (const auto& [ipa, visemes] : cases) {
    std::string unknown;
    auto shapes = mouth_shapes(ipa, &unknown);
    EXPECT_EQ(unknown, "") << ipa;
    ASSERT_EQ(shapes.size(), visemes.size()) << ipa;
    double parts = 0;
    for (size_t i = 0; i < shapes.size(); i++) {
      EXPECT_EQ(shapes[i].viseme, visemes[i]) << ipa;
      parts += double(shapes[i].part);
    }
    EXPECT_NEAR(parts, shapes.empty() ? 0 : 1, 1e-6) << ipa;
  }
}

TEST(SpeechVisemes, UnknownSymbolsAreNamedOnce) {
  std::string unknown;
  EXPECT_EQ(mouth_shapes("☂a☂", &unknown).size(), 1u);
  EXPECT_EQ(unknown, "☂");
}

TEST(SpeechVisemes, WeightsArePartOfOneAtEveryTime) {
  Rng rng{7};
  for (int round = 0; round < 50; round++) {
    VisemeTrack track = make_visemes(random_sounds(rng, 40));
    for (size_t i = 1; i < track.keys.size(); i++)
      EXPECT_GT(track.keys[i].time, track.keys[i - 1].time);
    for (double t = -0.1; t < 3; t += 0.0037) {
      VisemeWeights weights = eval_visemes(track, t);
      float sum = 0;
      for (float weight : weights) {
        EXPECT_GE(weight, 0);
        EXPECT_LE(weight, 1);
        sum += weight;
      }
      EXPECT_NEAR(sum, 1, 1e-5f);
    }
  }
}

TEST(SpeechVisemes, LipsCloseForEveryBilabialWhateverIsAround) {
  Rng rng{11};
  for (int round = 0; round < 100; round++) {
    auto sounds = random_sounds(rng, 30);
    VisemeTrack track = make_visemes(sounds);
    for (const MouthSound& sound : sounds) {
      if (sound.shapes.size() != 1 || sound.shapes[0].kind != MouthKind::closure) continue;
      if (sound.end - sound.begin < 0.04) continue;
      for (double x : {0.25, 0.5})
        EXPECT_GE(at(eval_visemes(track, sound.begin + x * (sound.end - sound.begin)), Viseme::PP),
                  0.9f);
    }
  }
}

TEST(SpeechVisemes, ClosureIsThereWhenTheSoundBeginsAndLabiodentalsDominate) {
  VisemeTrack track = make_visemes(sounds_of(
      {{"_", 0.3}, {"a", 0.12}, {"b", 0.08}, {"u", 0.12}, {"f", 0.1}, {"a", 0.15}, {"_", 0.3}}));
  EXPECT_GE(at(eval_visemes(track, 0.42), Viseme::PP), 0.99f);
  EXPECT_GE(at(eval_visemes(track, 0.47), Viseme::PP), 0.99f);
  EXPECT_GE(at(eval_visemes(track, 0.67), Viseme::FF), 0.9f);
  EXPECT_GE(at(eval_visemes(track, 0.36), Viseme::aa), 0.95f);
  EXPECT_GE(at(eval_visemes(track, 0.56), Viseme::ou), 0.95f);
  EXPECT_GE(at(eval_visemes(track, 0.05), Viseme::sil), 0.99f);
  EXPECT_GE(at(eval_visemes(track, 2.0), Viseme::sil), 0.99f);
}

TEST(SpeechVisemes, ConsonantsOfTheTongueLookAheadToTheirVowel) {
  auto share = [&](const char* vowel, Viseme viseme) {
    auto track = make_visemes(sounds_of({{"_", 0.2}, {"k", 0.1}, {vowel, 0.2}, {"_", 0.2}}));
    return at(eval_visemes(track, 0.245), viseme);
  };
  EXPECT_GT(share("u", Viseme::ou), 0.4f);
  EXPECT_GT(share("a", Viseme::aa), 0.4f);
  EXPECT_EQ(share("a", Viseme::ou), 0.0f);
  EXPECT_GT(share("u", Viseme::kk), 0.2f);
}

TEST(SpeechVisemes, DiphthongsGlideAndShortPausesDoNotCloseTheMouth) {
  auto track = make_visemes(sounds_of({{"aɪ", 0.3}, {"_", 0.05}, {"aɪ", 0.3}}));
  EXPECT_GT(at(eval_visemes(track, 0.09), Viseme::aa), 0.95f);
  EXPECT_GT(at(eval_visemes(track, 0.24), Viseme::ih), 0.95f);
  float rest = 0;
  for (double t = 0.2; t < 0.45; t += 0.005)
    rest = std::max(rest, at(eval_visemes(track, t), Viseme::sil));
  EXPECT_EQ(rest, 0.0f);
}

// The value is a function of time alone, and its speed is bounded and continuous: smoothstep over
// at least `shortest` seconds has |dw/dt| <= 1.5 / shortest and |d2w/dt2| <= 6 / shortest^2.
TEST(SpeechVisemes, NoJumpsAndNoCorners) {
  Rng rng{3};
  constexpr double step = 1e-4;
  auto track = make_visemes(sounds_of({{"_", .2},
                                       {"m", .07},
                                       {"a", .1},
                                       {"t", .05},
                                       {"u", .12},
                                       {"s", .1},
                                       {"aɪ", .2},
                                       {"n", .06},
                                       {"ɛ", .08},
                                       {"_", .3}}));
  double shortest = 1;
  for (size_t i = 1; i < track.keys.size(); i++)
    if (track.keys[i].weights != track.keys[i - 1].weights)
      shortest = std::min(shortest, track.keys[i].time - track.keys[i - 1].time);
  EXPECT_GE(shortest, 0.02);
  for (double t = 0; t < 1.5; t += step) {
    auto a = eval_visemes(track, t - step), b = eval_visemes(track, t),
         c = eval_visemes(track, t + step);
    for (size_t v = 0; v < viseme_count; v++) {
      EXPECT_LE(std::abs(double(c[v] - b[v])), 1.5 / shortest * step + 1e-5);
      EXPECT_LE(std::abs(double(c[v]) - 2 * double(b[v]) + double(a[v])),
                2 * 6 / (shortest * shortest) * step * step + 1e-6);
    }
  }
}

TEST(SpeechVisemes, NothingAndNonsenseAreSilence) {
  EXPECT_EQ(at(eval_visemes({}, 0), Viseme::sil), 1.0f);
  auto track = make_visemes(sounds_of({{"a", 0.2}}));
  EXPECT_EQ(at(eval_visemes(track, std::numeric_limits<double>::quiet_NaN()), Viseme::sil), 1.0f);
  EXPECT_EQ(at(eval_visemes(track, std::numeric_limits<double>::infinity()), Viseme::sil), 1.0f);
  EXPECT_TRUE(make_visemes({}).keys.empty());
}

}  // namespace
}  // namespace wellspring::test
