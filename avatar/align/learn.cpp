// SPDX-License-Identifier: Apache-2.0
#include "avatar/align/learn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wellspring::avatar {

namespace {

constexpr int best_rate = 16000;           // Hz for both sounds; less if one of them has less
constexpr double most_coarse_cells = 2e7;  // bytes of the coarse way's table
constexpr size_t least_coarse_step = 4;    // frames

// Costs of warping are in units of a mean squared normalised feature: 2 between frames that have
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

// Adds `share` of frame `from` of `features` to frame `to` of `sum`.
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
  std::vector<size_t> begins;  // first fine state of each coarse state
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

namespace {
constexpr double prior_frames = 12;  // number of recorded frames that the template's mean is worth
constexpr double prior_variance_frames = 100;  // the same for the variance of all kinds
constexpr double round_frames = 100;  // the same for the belief that features are independent

float gaussian_cost(const float* mean, const float* inverse, float constant, const float* frame) {
  float sum = 0;
  for (size_t c = 0; c < feature_count; c++) {
    float d = frame[c] - mean[c];
    sum += d * d * inverse[c];
  }
  return 0.5f * sum / feature_count + constant;
}

float gaussian_constant(const float* inverse) {
  float sum = 0;
  for (size_t c = 0; c < feature_count; c++) sum -= std::log(inverse[c]);
  return 0.5f * sum / feature_count;
}

// Learns silence from the quiet frames that were left out, or from all quiet ones if these are few.
void learn_silence(const Features& recorded, const std::vector<int32_t>& way,
                   const std::vector<float>& chance, SoundModel& model) {
  constexpr size_t n = feature_count;
  model.silence_mean.assign(n, 0);
  model.silence_inverse_variance.assign(n, 1);
  for (bool all : {false, true}) {
    std::vector<double> sum(n), squares(n);
    double count = 0;
    for (size_t t = 0; t < way.size(); t++) {
      if (chance[t] > 0.5f || (way[t] >= 0 && !all)) continue;
      for (size_t c = 0; c < n; c++) {
        double x = double(recorded.frame(t)[c]);
        sum[c] += x, squares[c] += x * x;
      }
      count++;
    }
    if (count < 20) continue;
    for (size_t c = 0; c < n; c++) {
      double mean = sum[c] / count;
      model.silence_mean[c] = float(mean);
      model.silence_inverse_variance[c] =
          float(1 / std::max(squares[c] / count - mean * mean, 0.05));
    }
    return;
  }
  // This recording has no silence, so no frame is like it.
  model.silence_mean.assign(n, -10);
}

}  // namespace

SoundModel learn_sounds(const Features& spoken, const Features& recorded, const Hearing& hearing) {
  constexpr size_t n = feature_count;
  const auto& [states, way, chance, kinds] = hearing;
  std::vector<double> own(kinds * n), heard(kinds * n), own_count(kinds), heard_count(kinds);
  for (const SoundState& state : states)
    for (size_t f = state.frame; f < state.frame + state.frames; f++) {
      for (size_t c = 0; c < n; c++) own[state.kind * n + c] += double(spoken.frame(f)[c]);
      own_count[state.kind]++;
    }
  for (size_t t = 0; t < way.size(); t++) {
    if (way[t] < 0) continue;
    uint32_t kind = states[size_t(way[t])].kind;
    for (size_t c = 0; c < n; c++) heard[kind * n + c] += double(recorded.frame(t)[c]);
    heard_count[kind]++;
  }
  for (uint32_t k = 0; k < kinds; k++)
    for (size_t c = 0; c < n; c++) {
      if (own_count[k] > 0) own[k * n + c] /= own_count[k];
      if (heard_count[k] > 0) heard[k * n + c] /= heard_count[k];
    }

  SoundModel model;
  model.mean.resize(kinds * n);
  model.inverse_variance.resize(kinds * n);
  for (size_t c = 0; c < n; c++) {
    // Fits the narrator's values of a feature by a line over the template's, over the kinds heard.
    double w = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (uint32_t k = 0; k < kinds; k++) {
      double weight = std::min(heard_count[k], 50.0);
      double a = own[k * n + c], b = heard[k * n + c];
      w += weight, x += weight * a, y += weight * b, xx += weight * a * a, xy += weight * a * b;
    }
    double spread = w > 0 ? xx / w - (x / w) * (x / w) : 0;
    double slope = w > 0 ? std::clamp((xy / w - x / w * y / w) / (spread + 0.05), 0.0, 2.0) : 1;
    double shift = w > 0 ? y / w - slope * x / w : 0;
    for (uint32_t k = 0; k < kinds; k++) {
      double prior = slope * own[k * n + c] + shift;
      model.mean[k * n + c] = float((prior * prior_frames + heard[k * n + c] * heard_count[k]) /
                                    (prior_frames + heard_count[k]));
    }
    double all = 0, count = 0;
    std::vector<double> squares(kinds);
    for (size_t t = 0; t < way.size(); t++) {
      if (way[t] < 0) continue;
      uint32_t kind = states[size_t(way[t])].kind;
      double d = double(recorded.frame(t)[c] - model.mean[kind * n + c]);
      squares[kind] += d * d, all += d * d, count++;
    }
    double usual = std::max(count > 0 ? all / count : 1, 0.05);
    for (uint32_t k = 0; k < kinds; k++) {
      double variance =
          (squares[k] + prior_variance_frames * usual) / (heard_count[k] + prior_variance_frames);
      model.inverse_variance[k * n + c] = float(1 / std::max(variance, 0.05));
    }
  }
  for (uint32_t k = 0; k < kinds; k++)
    model.constant.push_back(gaussian_constant(&model.inverse_variance[k * n]));
  learn_silence(recorded, way, chance, model);
  model.silence_constant = gaussian_constant(model.silence_inverse_variance.data());
  return model;
}

void whiten(Features& spoken, Features& recorded, const Hearing& hearing, const SoundModel& model) {
  constexpr size_t n = feature_count;
  const auto& [states, way, chance, kinds] = hearing;
  std::vector<double> scatter(n * n), lower(n * n);
  double count = 0;
  for (size_t t = 0; t < way.size(); t++) {
    if (way[t] < 0) continue;
    const float* mean = &model.mean[size_t(states[size_t(way[t])].kind) * n];
    const float* x = recorded.frame(t);
    for (size_t a = 0; a < n; a++)
      for (size_t b = 0; b <= a; b++)
        scatter[a * n + b] += double((x[a] - mean[a]) * (x[b] - mean[b]));
    count++;
  }
  // Computes Cholesky's factor of the covariance; dividing by it makes the deviations independent.
  for (size_t a = 0; a < n; a++)
    for (size_t b = 0; b <= a; b++) {
      double v = (scatter[a * n + b] + (a == b ? round_frames : 0)) / (count + round_frames);
      for (size_t k = 0; k < b; k++) v -= lower[a * n + k] * lower[b * n + k];
      lower[a * n + b] = a == b ? std::sqrt(std::max(v, 1e-6)) : v / lower[b * n + b];
    }
  for (Features* features : {&spoken, &recorded})
    for (size_t t = 0; t < features->size(); t++) {
      std::array<double, n> y;
      float* x = features->frame(t);
      for (size_t a = 0; a < n; a++) {
        double v = double(x[a]);
        for (size_t k = 0; k < a; k++) v -= lower[a * n + k] * y[k];
        y[a] = v / lower[a * n + a];
      }
      std::copy(y.begin(), y.end(), x);
    }
}

float silence_cost(const SoundModel& model, const float* frame) {
  return gaussian_cost(model.silence_mean.data(), model.silence_inverse_variance.data(),
                       model.silence_constant, frame);
}

float sound_cost(const SoundModel& model, uint32_t kind, const float* frame) {
  size_t at = size_t(kind) * feature_count;
  return gaussian_cost(&model.mean[at], &model.inverse_variance[at], model.constant[kind], frame);
}

float nearest_cost(const SoundModel& model, const float* frame) {
  uint32_t kinds = uint32_t(model.mean.size() / feature_count);
  float least = std::numeric_limits<float>::infinity();
  for (uint32_t k = 0; k < kinds; k++) least = std::min(least, sound_cost(model, k, frame));
  return least;
}

}  // namespace wellspring::avatar
