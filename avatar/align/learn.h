// SPDX-License-Identifier: Apache-2.0
// Learns a narrator's phonemes from a recording and a first guess at their times: one Gaussian a
// kind of sound.
#pragma once
#include <cstdint>
#include <vector>

#include "avatar/align/features.h"
#include "avatar/align/time_warp.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

// Turns a recording and the text as it is synthesised into features that can be compared, and finds
// the first, coarse way from one to the other.

struct SoundPair {
  Features spoken, recorded;  // both normalised over their speech
  std::vector<float> chance;  // each recorded frame's chance to be speech, 0 to 1
};
SoundPair make_sound_pair(const Speech& spoken, const Sound& recording);

// Returns about 2 for frames that have nothing to do with each other, about 1 for the same sound of
// two voices.
float feature_distance(const float* a, const float* b);

// Sets the costs of gaps, of staying and of skipping for frames that are compared by
// feature_distance; each frame of the task is made of `step` frames.
void set_template_costs(WarpTask& task, const std::vector<float>& chance, size_t step);

// Lets the speaker of single frames' states repeat words or beginnings of them, and fall silent
// within.
void let_stutter(WarpTask& task, const std::vector<float>& chance,
                 const std::vector<SoundState>& states);

struct CoarseWay {
  std::vector<int32_t> way;  // approximate state of each recorded frame; empty: there is no way
  double cost = 0;           // mean over the recorded frames
};
// Warps means of some frames onto means of as many states of a word: at most 20 million
// comparisons.
CoarseWay warp_coarsely(const SoundPair& pair, const std::vector<SoundState>& states);

struct SoundModel {
  std::vector<float> mean;              // feature_count a kind
  std::vector<float> inverse_variance;  // feature_count a kind
  std::vector<float> constant;          // half the mean log variance, one a kind
  std::vector<float> silence_mean, silence_inverse_variance;  // frames left out
  float silence_constant = 0;
};

// Holds a first guess: `way` gives the state of each recorded frame, negative for none; `chance`
// says how likely each frame is speech.
struct Hearing {
  const std::vector<SoundState>& states;
  const std::vector<int32_t>& way;
  const std::vector<float>& chance;
  uint32_t kinds = 0;
};

// Learns one Gaussian a kind. If there are few frames, means are held to the template's, mapped by
// a line from its features to the recording's, and variances to those of all kinds together
// (maximum a posteriori: Gauvain & Lee 1994, section III).
SoundModel learn_sounds(const Features& spoken, const Features& recorded, const Hearing& hearing);

// Turns and scales both sets of features so that deviations from the model's means are independent
// and have variance 1. The model does not fit afterwards and must be learnt anew.
void whiten(Features& spoken, Features& recorded, const Hearing& hearing, const SoundModel& model);

// Returns minus the log likelihood of a frame, over the number of features and without the constant
// that all models share; about 1/2 plus the kind's `constant` if the model is right.
float sound_cost(const SoundModel& model, uint32_t kind, const float* frame);
float silence_cost(const SoundModel& model, const float* frame);
float nearest_cost(const SoundModel& model, const float* frame);  // the likeliest kind's cost

}  // namespace wellspring::avatar
