// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech_align.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "avatar/speech_features.h"
#include "avatar/speech_learn.h"
#include "avatar/speech_template.h"
#include "avatar/speech_warp.h"

namespace wellspring {

namespace {

constexpr int best_rate = 16000;           // Hz; of both sounds, less where one has less
constexpr double most_coarse_cells = 2e7;  // bytes of the coarse way's table
constexpr size_t least_coarse_step = 4;    // frames
constexpr size_t band_frames = 150;        // either side of the way before
constexpr int rounds = 10, whitening_round = 4;  // of learning and dividing anew

// Costs of warping, in units of a mean squared normalised feature: 2 between frames that have
// nothing to do with each other, about 1 between the same sound of two voices.
constexpr float gap_of_silence = 0.3f, gap_of_sound = 1.3f, enter_gap = 10;
constexpr float stay_cost = 0.05f, skip_cost = 0.2f;
// Costs of dividing by the learnt models, where a right frame costs 1/2 more than the constant.
constexpr float model_gap_of_sound = 2, model_enter_gap = 1, model_stay_cost = 0.02f;

struct Pair {
  Features spoken, recorded;
  std::vector<float> chance;  // of the recorded frames to be speech
};

Pair make_pair_of(const Speech& spoken, const Sound& recording) {
  int rate = std::min({best_rate, recording.rate, spoken.rate});
  Pair pair;
  pair.spoken = make_features(resample(from_pcm(spoken.pcm), spoken.rate, rate), rate);
  pair.recorded = make_features(resample(recording.samples, recording.rate, rate), rate);
  pair.chance = speech_chance(pair.recorded);
  normalise(pair.spoken, find_speech(pair.spoken));
  normalise(pair.recorded, find_speech(pair.recorded));
  return pair;
}

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

float distance(const float* a, const float* b) {
  static const std::array<float, feature_count> weights = make_weights();
  float sum = 0;
  for (size_t c = 0; c < feature_count; c++) sum += weights[c] * (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

void set_warp_costs(WarpTask& task, const std::vector<float>& chance) {
  for (float c : chance)
    task.gap_cost.push_back(gap_of_silence + c * (gap_of_sound - gap_of_silence));
  task.stay = stay_cost;
  task.skip = skip_cost;
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

// About which state each recorded frame is, from means of `step` frames against means of up to
// `step` states of a word. Empty: there is no way.
std::vector<int32_t> warp_coarsely(const Pair& pair, const std::vector<SoundState>& fine,
                                   size_t step) {
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
  task.enter_gap = enter_gap / float(step);
  set_warp_costs(task, chance);
  task.costs = [&](size_t t, size_t first, size_t last, float* out) {
    for (size_t j = first; j < last; j++) *out++ = distance(recorded.frame(t), templates.frame(j));
  };
  WarpResult coarse = warp(task);
  std::vector<int32_t> way;
  if (!coarse.found) return way;
  for (size_t t = 0; t < frames; t++) {
    int32_t at = coarse.way[t / step];
    way.push_back(int32_t(begins[size_t(at < 0 ? -1 - at : at)]));
  }
  return way;
}

// The states that a way of other states comes by, of both the same phonemes in the same order; for
// a band, where only the neighbourhood counts. Gaps stand at the state that follows.
std::vector<int32_t> positions(const std::vector<int32_t>& way) {
  std::vector<int32_t> list;
  for (int32_t at : way) list.push_back(at < 0 ? -1 - at : at);
  return list;
}

void set_band(WarpTask& task, const std::vector<int32_t>& position) {
  size_t frames = position.size(), reach = band_frames;
  task.first.assign(frames, 0);
  task.last.assign(frames, uint32_t(task.templates));
  for (size_t t = 0; t < frames; t++) {
    if (t >= reach) {
      size_t early = size_t(position[t - reach]);
      early = std::min(early > reach ? early - reach : 0, task.templates - 1);
      task.first[t] = uint32_t(early);
    }
    if (t + reach < frames)
      task.last[t] = uint32_t(std::min(size_t(position[t + reach]) + reach + 1, task.templates));
  }
}

std::vector<int32_t> warp_finely(const Pair& pair, const std::vector<SoundState>& states,
                                 const std::vector<int32_t>& coarse) {
  WarpTask task;
  task.frames = pair.recorded.size();
  task.templates = states.size();
  task.gap_before = gaps_before(states);
  task.enter_gap = enter_gap;
  set_warp_costs(task, pair.chance);
  task.costs = [&](size_t t, size_t first, size_t last, float* out) {
    for (size_t j = first; j < last; j++)
      *out++ = distance(pair.recorded.frame(t), pair.spoken.frame(states[j].frame));
  };
  set_band(task, coarse);
  return warp(task).way;
}

// A way over frames of the template as a way over pieces of its phonemes.
std::vector<int32_t> to_pieces(const std::vector<int32_t>& way,
                               const std::vector<SoundState>& states,
                               const std::vector<SoundState>& pieces) {
  std::vector<int32_t> piece_of;
  size_t k = 0;
  for (const SoundState& state : states) {
    while (k + 1 < pieces.size() && (pieces[k].phoneme < state.phoneme ||
                                     (pieces[k + 1].phoneme == state.phoneme &&
                                      pieces[k + 1].frame <= state.frame)))
      k++;
    piece_of.push_back(int32_t(k));
  }
  piece_of.push_back(int32_t(pieces.size()));
  std::vector<int32_t> list;
  for (int32_t at : way)
    list.push_back(at < 0 ? -1 - piece_of[size_t(-1 - at)] : piece_of[size_t(at)]);
  return list;
}

WarpResult divide(const Pair& pair, const std::vector<SoundState>& pieces,
                  const std::vector<int32_t>& way, const SoundModel& model) {
  WarpTask task;
  task.frames = pair.recorded.size();
  task.templates = pieces.size();
  task.gap_before = gaps_before(pieces);
  task.may_skip = false;
  task.enter_gap = model_enter_gap;
  task.stay = model_stay_cost;
  for (const SoundState& piece : pieces) task.expected.push_back(float(piece.frames));
  float foreign = expected_cost(model) - 0.5f + model_gap_of_sound;
  for (size_t t = 0; t < task.frames; t++)
    task.gap_cost.push_back(std::min(silence_cost(model, pair.recorded.frame(t)), foreign));
  task.costs = [&](size_t t, size_t first, size_t last, float* out) {
    for (size_t j = first; j < last; j++)
      *out++ = sound_cost(model, pieces[j].kind, pair.recorded.frame(t));
  };
  set_band(task, positions(way));
  return warp(task);
}

// Learns the narrator's sounds and divides the recording by them, in turns. Ends early when nothing
// changes any more.
void refine(Pair& pair, const std::vector<SoundState>& pieces, uint32_t kinds,
            std::vector<int32_t>& way) {
  for (int round = 0; round < rounds; round++) {
    Hearing hearing{pieces, way, pair.chance, kinds};
    SoundModel model = learn_sounds(pair.spoken, pair.recorded, hearing);
    if (round == whitening_round) {
      whiten(pair.spoken, pair.recorded, hearing, model);
      model = learn_sounds(pair.spoken, pair.recorded, hearing);
    }
    WarpResult next = divide(pair, pieces, way, model);
    if (!next.found) return;  // the recording is too fast for three states a phoneme
    if (next.way == way && round > whitening_round) return;
    way = std::move(next.way);
  }
}

// Times of phonemes and words from the frames that were given to their states.
void time_phonemes(const std::vector<SoundState>& states, const std::vector<int32_t>& way,
                   Speech& speech) {
  std::vector<double> begin(speech.phonemes.size(), -1), end(speech.phonemes.size(), -1);
  for (size_t t = 0; t < way.size(); t++) {
    if (way[t] < 0) continue;
    size_t p = states[size_t(way[t])].phoneme;
    if (begin[p] < 0) begin[p] = std::max(0.0, (double(t) - 0.5) * feature_hop);
    end[p] = std::min(speech.duration, (double(t) + 0.5) * feature_hop);
  }
  std::vector<SpeechPhoneme> phonemes;
  double last = 0;
  for (size_t p = 0; p < speech.phonemes.size(); p++) {
    SpeechPhoneme& phoneme = speech.phonemes[p];
    if (phoneme.word < 0) continue;
    phoneme.begin = begin[p] < 0 ? last : std::max(begin[p], last);
    phoneme.end = begin[p] < 0 ? last : std::max(end[p], phoneme.begin);
    last = phoneme.end;
    phonemes.push_back(phoneme);
  }
  speech.phonemes = std::move(phonemes);
  for (SpeechWord& word : speech.words) word.begin = -1;
  for (const SpeechPhoneme& phoneme : speech.phonemes) {
    SpeechWord& word = speech.words[size_t(phoneme.word)];
    if (word.begin < 0) word.begin = phoneme.begin;
    word.end = phoneme.end;
  }
}

}  // namespace

double measure_pace(const Speech& spoken, const Sound& recording) {
  auto seconds = [](const std::vector<float>& samples, int rate) {
    std::vector<bool> speech = find_speech(make_features(samples, rate));
    return double(std::count(speech.begin(), speech.end(), true));
  };
  double own = seconds(from_pcm(spoken.pcm), spoken.rate);
  return own > 0 ? std::clamp(seconds(recording.samples, recording.rate) / own, 0.3, 3.0) : 1;
}

Speech align_speech(const Speech& spoken, const Sound& recording) {
  Pair pair = make_pair_of(spoken, recording);
  float loudest = *std::max_element(pair.recorded.loudness.begin(), pair.recorded.loudness.end());
  if (loudest < quietest_speech) throw std::runtime_error("there is no sound in the recording");
  auto states = make_states(spoken, pair.spoken.size(), 0);
  if (states.empty()) throw std::runtime_error("there is nothing in the text that can be spoken");

  double cells = double(states.size()) * double(pair.recorded.size());
  size_t step = size_t(std::ceil(std::sqrt(cells / most_coarse_cells)));
  step = std::max(least_coarse_step, step);
  std::vector<int32_t> way = warp_coarsely(pair, states, step);
  if (!way.empty()) way = warp_finely(pair, states, way);
  if (way.empty()) throw std::runtime_error("the recording is too short for the text");

  auto pieces = make_states(spoken, pair.spoken.size(), 3);
  uint32_t kinds = number_kinds(spoken, pieces);
  way = to_pieces(way, states, pieces);
  refine(pair, pieces, kinds, way);

  Speech speech = spoken;
  speech.rate = recording.rate;
  speech.pcm = to_pcm(recording.samples);
  speech.duration = double(speech.pcm.size()) / speech.rate;
  time_phonemes(pieces, way, speech);
  fit_phonemes(speech);
  fill_visemes(speech);
  return speech;
}

}  // namespace wellspring
