// SPDX-License-Identifier: Apache-2.0
#include "avatar/align/coarse.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wellspring::avatar {

namespace {

constexpr int best_rate = 16000;           // Hz; of both sounds, less where one has less
constexpr double most_coarse_cells = 2e7;  // bytes of the coarse way's table
constexpr size_t least_coarse_step = 4;    // frames

// Costs of warping, in units of a mean squared normalised feature: 2 between frames that have
// nothing to do with each other, about 1 between the same sound of two voices.
constexpr float gap_of_silence = 0.3f, gap_of_sound = 1.3f, enter_gap = 10;
constexpr float stay_cost = 0.05f, skip_cost = 0.2f;
constexpr float block_of_sound = 4, enter_block = 10, return_cost = 10, return_word_cost = 5;
// Fine structure and slopes differ more between voices than the broad shape of a spectrum does, so
// they count for less.
std::array<float, feature_count> make_weights() {
  std::array<float, feature_count> weights;
  float sum = 0;
  for (int c = 0; c < feature_count; c++) {
    float order = float(c % cepstra) / 4;
    weights[size_t(c)] = (c < cepstra ? 1 : 0.7f) / (1 + order * order);
    sum += weights[size_t(c)];
  }
  for (float& weight : weights) weight /= sum;
  return weights;
}

// Adds frame `from` of one to frame `to` of the other, `share` of it.
void add_frame(Features& sum, size_t to, const Features& features, size_t from, float share) {
  for (size_t c = 0; c < feature_count; c++) sum.frame(to)[c] += features.frame(from)[c] * share;
}

Features make_empty(size_t count) {
  Features features;
  features.values.resize(count * feature_count);
  features.loudness.resize(count);
  return features;
}

}  // namespace

SoundPair make_sound_pair(const Speech& spoken, const Sound& recording) {
  int rate = std::min({best_rate, recording.rate, spoken.rate});
  SoundPair pair;
  pair.spoken = make_features(resample(from_pcm(spoken.pcm), spoken.rate, rate), rate);
  pair.recorded = make_features(resample(recording.samples, recording.rate, rate), rate);
  pair.chance = speech_chance(pair.recorded);
  normalise(pair.spoken, find_speech(pair.spoken));
  normalise(pair.recorded, find_speech(pair.recorded));
  return pair;
}

float feature_distance(const float* a, const float* b) {
  static const std::array<float, feature_count> weights = make_weights();
  float sum = 0;
  for (size_t c = 0; c < feature_count; c++) sum += weights[c] * (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

void set_template_costs(WarpTask& task, const std::vector<float>& chance, size_t step) {
  task.enter_gap = enter_gap / float(step);
  for (float c : chance)
    task.gap_cost.push_back(gap_of_silence + c * (gap_of_sound - gap_of_silence));
  task.stay = stay_cost;
  task.skip = skip_cost;
}

void let_stutter(WarpTask& task, const std::vector<float>& chance,
                 const std::vector<SoundState>& states) {
  task.gap_before = gaps_before(states, true);
  task.enter_silence = enter_block;
  for (float c : chance)
    task.silence_cost.push_back(gap_of_silence + c * (block_of_sound - gap_of_silence));
  task.returns = find_returns(states, return_cost, return_word_cost);
}

CoarseWay warp_coarsely(const SoundPair& pair, const std::vector<SoundState>& fine) {
  double cells = double(fine.size()) * double(pair.recorded.size());
  size_t step =
      std::max(least_coarse_step, size_t(std::ceil(std::sqrt(cells / most_coarse_cells))));
  std::vector<size_t> begins;  // of the coarse states, in fine ones
  std::vector<SoundState> states;
  for (size_t i = 0; i < fine.size(); i++)
    if (fine[i].word_begins || i - begins.back() == step) {
      begins.push_back(i);
      states.push_back(fine[i]);
    }
  begins.push_back(fine.size());
  Features templates = make_empty(states.size());
  for (size_t k = 0; k < states.size(); k++)
    for (size_t i = begins[k]; i < begins[k + 1]; i++)
      add_frame(templates, k, pair.spoken, fine[i].frame, 1 / float(begins[k + 1] - begins[k]));

  size_t frames = pair.recorded.size(), count = (frames + step - 1) / step;
  Features recorded = make_empty(count);
  std::vector<float> chance(count);
  for (size_t t = 0; t < frames; t++) {
    float share = 1 / float(std::min(step, frames - t / step * step));
    add_frame(recorded, t / step, pair.recorded, t, share);
    chance[t / step] += pair.chance[t] * share;
  }

  WarpTask task;
  task.frames = count;
  task.templates = states.size();
  task.gap_before = gaps_before(states);
  set_template_costs(task, chance, step);
  task.costs = [&](size_t t, size_t first, size_t last, float* out) {
    for (size_t j = first; j < last; j++)
      *out++ = feature_distance(recorded.frame(t), templates.frame(j));
  };
  WarpResult coarse = warp(task);
  CoarseWay result;
  if (!coarse.found) return result;
  result.cost = coarse.cost / double(count);
  for (size_t t = 0; t < frames; t++) {
    int32_t at = coarse.way[t / step];
    result.way.push_back(int32_t(begins[size_t(at < 0 ? -1 - at : at)]));
  }
  return result;
}

}  // namespace wellspring::avatar
