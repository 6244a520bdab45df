// SPDX-License-Identifier: Apache-2.0
// Lips against sound, over the stories that the castle tells: when the mouth opens after a silence
// and when it rests again, against the energy of what is heard.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "avatar/speech/process.h"
#include "avatar/story/story_speech.h"
#include "base/layers.h"

namespace wellspring::test {
namespace {

constexpr double window = 0.005;
constexpr int least_silence = 20;  // windows

StorySpeech tell(const std::string& story, const std::string& lang) {
  std::string path =
      std::string(WELLSPRING_SOURCE) + "/content/castle/stories/" + story + "." + lang + ".story";
  std::ifstream in(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  StoryScript script = read_story(text, path);
  EXPECT_TRUE(script.notes.empty()) << path;
  SpeechProcess process;
  std::vector<std::shared_ptr<const Speech>> spoken;
  for (const StoryLine& line : script.lines) {
    std::string error;
    SpeechRequest request{
        .text = line.text, .lang = lang, .words_per_minute = 145, .pitch = 52, .variant = "f3"};
    request.styles = line.styles;
    spoken.push_back(process.speak(request, error));
    EXPECT_TRUE(spoken.back()) << error;
  }
  return join_lines(script.lines, spoken);
}

struct Edges {
  std::vector<double> begins, ends;  // seconds; each sound lies between silences
};

// Windows of 5 ms that are louder than 40 dB under the loudest.
Edges edges_of(const Speech& speech) {
  size_t size = size_t(window * speech.rate);
  std::vector<double> energy;
  for (size_t i = 0; i + size <= speech.pcm.size(); i += size) {
    double sum = 0;
    for (size_t k = i; k < i + size; k++) sum += double(speech.pcm[k]) * double(speech.pcm[k]);
    energy.push_back(sum);
  }
  double threshold = 1e-4 * *std::max_element(energy.begin(), energy.end());
  Edges edges;
  int quiet = 1000;
  double last = 0;
  for (size_t i = 0; i < energy.size(); i++) {
    if (energy[i] <= threshold) {
      quiet++;
      continue;
    }
    double at = double(i * size) / speech.rate;
    if (quiet >= least_silence) {
      if (!edges.begins.empty()) edges.ends.push_back(last);
      edges.begins.push_back(at);
    }
    quiet = 0;
    last = at + window;
  }
  edges.ends.push_back(last);
  return edges;
}

// When the mouth leaves its rest, and comes back to it: half way.
Edges mouth_edges(const Speech& speech) {
  Edges edges;
  bool open = false;
  for (double t = 0; t < speech.duration + 0.5; t += 0.001) {
    bool now = eval_visemes(speech.visemes, t)[size_t(Viseme::sil)] < 0.5f;
    if (now && !open) edges.begins.push_back(t);
    if (!now && open) edges.ends.push_back(t);
    open = now;
  }
  return edges;
}

void add_errors(const std::vector<double>& heard, const std::vector<double>& seen,
                std::vector<double>& errors) {
  for (double at : heard) {
    double nearest = 1;
    for (double other : seen)
      if (std::abs(other - at) < std::abs(nearest)) nearest = other - at;
    errors.push_back(nearest);  // positive: the lips are late
  }
}

std::vector<double> magnitudes(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return values;
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[std::min(size_t(q * double(values.size())), values.size() - 1)];
}

class StoryLips : public testing::TestWithParam<const char*> {};

TEST_P(StoryLips, OpenAndCloseWithTheSound) {
  std::vector<double> begins, ends;
  size_t words = 0;
  for (const char* story : {"well", "crown", "horse"}) {
    StorySpeech told = tell(story, GetParam());
    EXPECT_GT(told.speech.duration, 60) << story;
    EXPECT_LT(told.speech.duration, 120) << story;
    ASSERT_EQ(told.cues.size(), told.begins.size());
    Edges heard = edges_of(told.speech), seen = mouth_edges(told.speech);
    add_errors(heard.begins, seen.begins, begins);
    add_errors(heard.ends, seen.ends, ends);
    words += told.speech.words.size();
  }
  EXPECT_GT(begins.size(), 60u);
  EXPECT_GT(words, 400u);
  begins = magnitudes(begins);
  RecordProperty("median_begin_ms", int(1e3 * quantile(begins, 0.5)));
  RecordProperty("p95_begin_ms", int(1e3 * quantile(begins, 0.95)));
  RecordProperty("median_end_ms", int(1e3 * quantile(ends, 0.5)));
  RecordProperty("p95_end_ms", int(1e3 * quantile(ends, 0.95)));
  EXPECT_LE(quantile(begins, 0.5), 0.03);
  EXPECT_LE(quantile(begins, 0.95), 0.08);
  // A sound's end is less of an event than its beginning: nine in ten within the same bound.
  EXPECT_GE(quantile(ends, 0.05), -0.08);
  EXPECT_LE(quantile(ends, 0.95), 0.08);
}
INSTANTIATE_TEST_SUITE_P(Languages, StoryLips, testing::Values("en", "de", "sk"));

}  // namespace
}  // namespace wellspring::test
