// SPDX-License-Identifier: Apache-2.0
#include "avatar/align/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

namespace wellspring::avatar {

namespace {

constexpr int bands = 26;
constexpr double window_seconds = 0.025;
constexpr double lowest = 100, highest = 7000;  // Hz; the upper one is less at low sampling rates

constexpr float quietest = 1e-6f;  // least power of a band that counts

using Complex = std::complex<float>;

// Transforms `x` in place, radix 2 (Cooley & Tukey 1965); `turns` holds exp(-2 pi i k / n) for k <
// n / 2.
void transform(std::vector<Complex>& x, const std::vector<Complex>& turns) {
  size_t n = x.size();
  for (size_t i = 1, j = 0; i < n; i++) {
    size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (size_t length = 2; length <= n; length *= 2)
    for (size_t start = 0; start < n; start += length)
      for (size_t k = 0; k < length / 2; k++) {
        Complex a = x[start + k], b = x[start + k + length / 2] * turns[k * (n / length)];
        x[start + k] = a + b;
        x[start + k + length / 2] = a - b;
      }
}

double mel(double hertz) { return 1127 * std::log(1 + hertz / 700); }
double hertz(double mel) { return 700 * (std::exp(mel / 1127) - 1); }

// Holds triangles over the bins of a spectrum.
struct Filters {
  std::array<std::vector<float>, bands> weights;
  std::array<size_t, bands> first{};
};

Filters make_filters(size_t bins, int rate) {
  Filters filters;
  double top = std::min(highest, 0.46 * rate), from = mel(lowest), to = mel(top);
  double bin_width = 0.5 * rate / double(bins - 1);
  for (int b = 0; b < bands; b++) {
    double edge[3];
    for (int k = 0; k < 3; k++) edge[k] = hertz(from + (to - from) * (b + k) / (bands + 1));
    bool begun = false;
    for (size_t i = 0; i < bins; i++) {
      double f = double(i) * bin_width;
      double up = (f - edge[0]) / (edge[1] - edge[0]), down = (edge[2] - f) / (edge[2] - edge[1]);
      double weight = std::min(up, down);
      if (weight <= 0) continue;
      if (!begun) filters.first[size_t(b)] = i;
      begun = true;
      filters.weights[size_t(b)].push_back(float(weight));
    }
  }
  return filters;
}

// Computes slopes by least squares over two frames on either side.
void fill_slopes(Features& features) {
  ptrdiff_t count = ptrdiff_t(features.size());
  auto value = [&](ptrdiff_t i, int c) {
    return features.frame(size_t(std::clamp<ptrdiff_t>(i, 0, count - 1)))[c];
  };
  for (ptrdiff_t i = 0; i < count; i++)
    for (int c = 0; c < cepstra; c++)
      features.frame(size_t(i))[cepstra + c] =
          (value(i + 1, c) - value(i - 1, c) + 2 * (value(i + 2, c) - value(i - 2, c))) / 10;
}

}  // namespace

Features make_features(const std::vector<float>& samples, int rate) {
  size_t width = size_t(std::lround(window_seconds * rate)), size = 1;
  while (size < width) size *= 2;
  std::vector<Complex> turns(size / 2), spectrum(size);
  for (size_t k = 0; k < turns.size(); k++)
    turns[k] = std::polar(1.0f, float(-2 * std::numbers::pi * double(k) / double(size)));
  std::vector<float> window(width);
  for (size_t i = 0; i < width; i++)
    window[i] =
        float(0.5 - 0.5 * std::cos(2 * std::numbers::pi * (double(i) + 0.5) / double(width)));
  Filters filters = make_filters(size / 2 + 1, rate);
  std::array<std::array<float, bands>, cepstra> cosines;
  for (int c = 0; c < cepstra; c++)
    for (int b = 0; b < bands; b++)
      cosines[size_t(c)][size_t(b)] = float(std::cos(std::numbers::pi * c * (b + 0.5) / bands));

  Features features;
  double hop = feature_hop * rate;
  size_t count = std::max<size_t>(1, size_t(double(samples.size()) / hop));
  features.values.resize(count * feature_count);
  features.loudness.resize(count);
  for (size_t i = 0; i < count; i++) {
    ptrdiff_t start = std::lround(double(i) * hop) - ptrdiff_t(width / 2);
    auto sample = [&](ptrdiff_t k) {
      return k >= 0 && k < ptrdiff_t(samples.size()) ? samples[size_t(k)] : 0.0f;
    };
    std::fill(spectrum.begin(), spectrum.end(), Complex(0));
    for (size_t k = 0; k < width; k++) {
      float x = sample(start + ptrdiff_t(k));
      spectrum[k] = window[k] * (x - 0.97f * sample(start + ptrdiff_t(k) - 1));
    }
    transform(spectrum, turns);
    std::array<float, bands> level;
    for (size_t b = 0; b < bands; b++) {
      float sum = 0;
      for (size_t k = 0; k < filters.weights[b].size(); k++)
        sum += filters.weights[b][k] * std::norm(spectrum[filters.first[b] + k]);
      level[b] = std::log(sum + quietest);
    }
    float* out = features.frame(i);
    float mean = 0;
    for (float value : level) mean += value / bands;
    features.loudness[i] = mean * float(10 / std::numbers::ln10);
    for (size_t c = 0; c < cepstra; c++) {
      float sum = 0;
      for (size_t b = 0; b < bands; b++) sum += cosines[c][b] * level[b];
      out[c] = sum / bands;
    }
  }
  fill_slopes(features);
  return features;
}

std::vector<float> speech_chance(const Features& features) {
  size_t count = features.size();
  std::vector<float> sorted = features.loudness;
  std::sort(sorted.begin(), sorted.end());
  double low = double(sorted[count / 10]), high = double(sorted[count - 1 - count / 10]);
  double variance[2] = {25, 25}, mean[2] = {low, high}, weight[2] = {0.5, 0.5};
  std::vector<float> chance(count, 1);
  if (high - low < 6) return chance;  // all is speech, or nothing is
  for (int round = 0; round < 30; round++) {
    double sum[2] = {}, first[2] = {}, second[2] = {};
    for (size_t i = 0; i < count; i++) {
      double x = double(features.loudness[i]), p[2];
      for (int k = 0; k < 2; k++)
        p[k] = std::log(weight[k]) - 0.5 * std::log(variance[k]) -
               0.5 * (x - mean[k]) * (x - mean[k]) / variance[k];
      double speech = 1 / (1 + std::exp(std::clamp(p[0] - p[1], -50.0, 50.0)));
      if (x < mean[0]) speech = 0;  // the wider bell wins far out on the wrong side
      if (x > mean[1]) speech = 1;
      chance[i] = float(speech);
      double share[2] = {1 - speech, speech};
      for (int k = 0; k < 2; k++)
        sum[k] += share[k], first[k] += share[k] * x, second[k] += share[k] * x * x;
    }
    for (int k = 0; k < 2; k++) {
      if (sum[k] < 1) return chance;
      mean[k] = first[k] / sum[k];
      variance[k] = std::max(second[k] / sum[k] - mean[k] * mean[k], 4.0);
      weight[k] = sum[k] / double(count);
    }
  }
  return chance;
}

std::vector<bool> find_speech(const Features& features) {
  std::vector<float> chance = speech_chance(features);
  size_t count = chance.size();
  std::vector<bool> speech(count);
  for (size_t i = 0; i < count; i++) speech[i] = chance[i] > 0.5f;
  for (bool value : {true, false})
    for (size_t i = 0; i < count;) {
      size_t end = i;
      while (end < count && speech[end] == speech[i]) end++;
      if (speech[i] != value && end - i < 3 && i > 0 && end < count)
        std::fill(speech.begin() + ptrdiff_t(i), speech.begin() + ptrdiff_t(end), value);
      i = end;
    }
  return speech;
}

void normalise(Features& features, const std::vector<bool>& speech) {
  for (int c = 0; c < feature_count; c++) {
    double sum = 0, squares = 0, count = 0;
    for (size_t i = 0; i < features.size(); i++) {
      if (!speech[i]) continue;
      double x = double(features.frame(i)[c]);
      sum += x, squares += x * x, count++;
    }
    if (count == 0) continue;
    double mean = sum / count, deviation = std::sqrt(std::max(squares / count - mean * mean, 1e-8));
    for (size_t i = 0; i < features.size(); i++)
      features.frame(i)[c] = float((double(features.frame(i)[c]) - mean) / deviation);
  }
}

namespace {

std::string kind_name(const SpeechPhoneme& phoneme) {
  std::string name = phoneme.ipa;
  for (const std::string mark : {"ː", "ˑ", "ˈ", "ˌ"})
    for (size_t at; (at = name.find(mark)) != std::string::npos;) name.erase(at, mark.size());
  return name;
}

}  // namespace

std::vector<SoundState> make_states(const Speech& spoken, size_t frame_count, size_t pieces) {
  std::vector<SoundState> states;
  int word = -1;
  for (size_t p = 0; p < spoken.phonemes.size(); p++) {
    const SpeechPhoneme& phoneme = spoken.phonemes[p];
    if (phoneme.word < 0) continue;
    size_t first = std::min(size_t(std::lround(phoneme.begin / feature_hop)), frame_count - 1);
    size_t end = size_t(std::lround(phoneme.end / feature_hop));
    size_t frames = std::clamp(end, first + 1, frame_count) - first;
    size_t count = pieces == 0 ? frames : std::clamp<size_t>(frames / 2, 1, pieces);
    for (size_t k = 0; k < count; k++) {
      SoundState state;
      state.phoneme = uint32_t(p);
      state.frame = first + frames * k / count;
      state.frames = first + frames * (k + 1) / count - state.frame;
      state.word_begins = k == 0 && phoneme.word != word;
      states.push_back(state);
    }
    word = phoneme.word;
  }
  return states;
}

uint32_t number_kinds(const Speech& spoken, std::vector<SoundState>& states) {
  std::map<std::pair<std::string, size_t>, uint32_t> numbers;
  for (size_t i = 0; i < states.size();) {
    size_t end = i;
    while (end < states.size() && states[end].phoneme == states[i].phoneme) end++;
    std::string name = kind_name(spoken.phonemes[states[i].phoneme]);
    for (size_t k = i; k < end; k++) {
      size_t place = k == i ? 0 : k + 1 == end ? 2 : 1;
      states[k].kind = numbers.try_emplace({name, place}, uint32_t(numbers.size())).first->second;
    }
    i = end;
  }
  return uint32_t(numbers.size());
}

std::vector<WarpGap> gaps_before(const std::vector<SoundState>& states, bool blocks) {
  std::vector<WarpGap> gaps;
  for (size_t i = 0; i < states.size(); i++) {
    bool phoneme_begins = i == 0 || states[i].phoneme != states[i - 1].phoneme;
    gaps.push_back(states[i].word_begins      ? WarpGap::anything
                   : blocks && phoneme_begins ? WarpGap::silence
                                              : WarpGap::none);
  }
  gaps.push_back(WarpGap::anything);
  return gaps;
}

std::vector<std::vector<WarpReturn>> find_returns(const std::vector<SoundState>& states, float cost,
                                                  float cost_of_word) {
  std::vector<std::vector<WarpReturn>> returns(states.size());
  constexpr size_t none = size_t(-1);
  size_t word = none, before = none;  // first states of the word and of the one before it
  for (size_t i = 0; i < states.size(); i++) {
    if (states[i].word_begins) before = word, word = i;
    bool phoneme_ends = i + 1 == states.size() || states[i + 1].phoneme != states[i].phoneme;
    if (!phoneme_ends) continue;
    if (word != none) returns[word].push_back({uint32_t(i), cost});
    if (before != none) returns[before].push_back({uint32_t(i), cost + cost_of_word});
  }
  return returns;
}

}  // namespace wellspring::avatar
