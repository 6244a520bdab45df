// SPDX-License-Identifier: Apache-2.0
#include "avatar/align/align.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "avatar/align/features.h"
#include "avatar/align/learn.h"
#include "avatar/align/time_warp.h"
#include "base/rng.h"

namespace wellspring::avatar {

namespace {

constexpr size_t band_frames = 150;              // frames on either side of the earlier way
constexpr int rounds = 10, whitening_round = 4;  // rounds of learning and dividing anew

// These are the costs of dividing by the learnt models; a right frame costs 1/2 more than the
// constant. They were chosen with synthetic narrators who stutter; within factors of two the shares
// barely change.
constexpr float model_gap_of_sound = 0.4f, model_enter_gap = 1, model_stay_cost = 0.01f;
constexpr float model_enter_block = 2, model_return = 3, model_return_word = 3;

// Returns the state at each frame of a way, in gaps the state that follows. The way may have other
// states of the same phonemes in the same order: a band needs the neighbourhood alone.
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
  // A way that goes back gets a band wide enough for both places.
  for (size_t t = 1; t < frames; t++) task.last[t] = std::max(task.last[t], task.last[t - 1]);
  for (size_t t = frames; t-- > 1;) task.first[t - 1] = std::min(task.first[t], task.first[t - 1]);
}

std::vector<int32_t> warp_finely(const SoundPair& pair, const std::vector<SoundState>& states,
                                 const std::vector<int32_t>& coarse) {
  WarpTask task;
  task.frames = pair.recorded.size();
  task.templates = states.size();
  set_template_costs(task, pair.chance, 1);
  let_stutter(task, pair.chance, states);
  task.costs = [&](size_t t, size_t first, size_t last, float* out) {
    for (size_t j = first; j < last; j++)
      *out++ = feature_distance(pair.recorded.frame(t), pair.spoken.frame(states[j].frame));
  };
  set_band(task, coarse);
  return warp(task).way;
}

// Turns a way over frames of the template into a way over pieces of its phonemes.
std::vector<int32_t> to_pieces(const std::vector<int32_t>& way,
                               const std::vector<SoundState>& states,
                               const std::vector<SoundState>& pieces) {
  std::vector<int32_t> piece_of;
  size_t k = 0;
  for (const SoundState& state : states) {
    while (k + 1 < pieces.size() &&
           (pieces[k].phoneme < state.phoneme ||
            (pieces[k + 1].phoneme == state.phoneme && pieces[k + 1].frame <= state.frame)))
      k++;
    piece_of.push_back(int32_t(k));
  }
  piece_of.push_back(int32_t(pieces.size()));
  std::vector<int32_t> list;
  for (int32_t at : way)
    list.push_back(at < 0 ? -1 - piece_of[size_t(-1 - at)] : piece_of[size_t(at)]);
  return list;
}

WarpResult divide(const SoundPair& pair, const std::vector<SoundState>& pieces,
                  const std::vector<int32_t>& way, const SoundModel& model) {
  WarpTask task;
  task.frames = pair.recorded.size();
  task.templates = pieces.size();
  task.gap_before = gaps_before(pieces, true);
  task.returns = find_returns(pieces, model_return, model_return_word);
  task.may_skip = false;
  task.enter_silence = model_enter_block;
  task.enter_gap = model_enter_gap;
  task.stay = model_stay_cost;
  for (const SoundState& piece : pieces) task.expected.push_back(float(piece.frames));
  for (size_t t = 0; t < task.frames; t++) {
    const float* frame = pair.recorded.frame(t);
    task.silence_cost.push_back(silence_cost(model, frame));
    // Sound that is not in the text is taken for the same sounds in any order.
    float foreign = nearest_cost(model, frame) + model_gap_of_sound;
    task.gap_cost.push_back(std::min(task.silence_cost[t], foreign));
  }
  task.costs = [&](size_t t, size_t first, size_t last, float* out) {
    for (size_t j = first; j < last; j++)
      *out++ = sound_cost(model, pieces[j].kind, pair.recorded.frame(t));
  };
  set_band(task, positions(way));
  return warp(task);
}

// Learns the narrator's sounds and divides the recording by them, in turns. Ends early when nothing
// changes any more.
void refine(SoundPair& pair, const std::vector<SoundState>& pieces, uint32_t kinds,
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

// Makes phonemes from `first` on that have a time sounds of no word, since they are said again.
void set_aside(size_t first, std::vector<double>& begin, std::vector<double>& end,
               const std::vector<SpeechPhoneme>& phonemes, std::vector<SpeechPhoneme>& in_vain) {
  for (size_t p = first; p < phonemes.size(); p++) {
    if (begin[p] < 0) continue;
    in_vain.push_back({begin[p], end[p], phonemes[p].mnemonic, phonemes[p].ipa, -1});
    begin[p] = -1;
  }
}

// Sets the times of phonemes and words from the frames that were given to their states.
void time_phonemes(const std::vector<SoundState>& states, const std::vector<int32_t>& way,
                   Speech& speech) {
  std::vector<double> begin(speech.phonemes.size(), -1), end(speech.phonemes.size(), -1);
  std::vector<SpeechPhoneme> in_vain;
  int32_t before = -1;
  for (size_t t = 0; t < way.size(); t++) {
    if (way[t] < 0) continue;
    size_t p = states[size_t(way[t])].phoneme;
    // If something is said more than once, the last time counts.
    if (way[t] < before) set_aside(p, begin, end, speech.phonemes, in_vain);
    before = way[t];
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
  for (SpeechWord& word : speech.words) word.begin = -1;
  for (const SpeechPhoneme& phoneme : phonemes) {
    SpeechWord& word = speech.words[size_t(phoneme.word)];
    if (word.begin < 0) word.begin = phoneme.begin;
    word.end = phoneme.end;
  }
  phonemes.insert(phonemes.end(), in_vain.begin(), in_vain.end());
  speech.phonemes = std::move(phonemes);
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
  SoundPair pair = make_sound_pair(spoken, recording);
  float loudest = *std::max_element(pair.recorded.loudness.begin(), pair.recorded.loudness.end());
  if (loudest < quietest_speech) throw std::runtime_error("there is no sound in the recording");
  auto states = make_states(spoken, pair.spoken.size(), 0);
  if (states.empty()) throw std::runtime_error("there is nothing in the text that can be spoken");

  std::vector<int32_t> way = warp_coarsely(pair, states).way;
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

namespace {

// Returns the states with their words in another order.
std::vector<SoundState> reorder(const std::vector<SoundState>& states, Rng& rng) {
  std::vector<std::pair<size_t, size_t>> words;  // first state of each word, one past its last
  for (size_t i = 0; i < states.size(); i++) {
    if (states[i].word_begins || words.empty()) words.push_back({i, i});
    words.back().second = i + 1;
  }
  for (size_t i = words.size(); i-- > 1;)
    std::swap(words[i], words[std::min(size_t(rng.uniform() * float(i + 1)), i)]);
  std::vector<SoundState> mixed;
  for (auto [first, last] : words)
    mixed.insert(mixed.end(), states.begin() + ptrdiff_t(first), states.begin() + ptrdiff_t(last));
  return mixed;
}

}  // namespace

double eval_fit(const Speech& spoken, const Sound& recording) {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  if (spoken.words.size() < size_t(fit_words)) return unknown;
  SoundPair pair = make_sound_pair(spoken, recording);
  auto states = make_states(spoken, pair.spoken.size(), 0);
  if (states.empty()) return unknown;
  CoarseWay own = warp_coarsely(pair, states);
  if (own.way.empty()) return 0;  // the recording is far too short for the text
  Rng rng{1};
  double sum = 0, squares = 0, count = 0;
  for (int i = 0; i < fit_orders; i++) {
    CoarseWay other = warp_coarsely(pair, reorder(states, rng));
    if (other.way.empty()) continue;
    sum += other.cost, squares += other.cost * other.cost, count++;
  }
  if (count < 2) return unknown;
  double mean = sum / count, variance = (squares - count * mean * mean) / (count - 1);
  return (mean - own.cost) / std::sqrt(std::max(variance, 1e-12));
}

}  // namespace wellspring::avatar
