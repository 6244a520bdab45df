// SPDX-License-Identifier: Apache-2.0
// A narrator's phonemes, learnt from his recording and a first guess where they are: one Gaussian a
// kind of sound.
#pragma once
#include <cstdint>
#include <vector>

#include "avatar/align/features.h"
#include "avatar/align/time_warp.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

// A recording and the text as it is synthesised, as features that can be compared, and the first,
// coarse way from one to the other.

struct SoundPair {
  Features spoken, recorded;  // both normalised over their speech
  std::vector<float> chance;  // of the recorded frames to be speech
};
SoundPair make_sound_pair(const Speech& spoken, const Sound& recording);

// About 2 between frames that have nothing to do with each other, 1 between the same sound of two
// voices.
float feature_distance(const float* a, const float* b);

// Costs of gaps, of staying and of skipping when frames are compared by feature_distance; `step`:
// how many frames one of the task's is made of.
void set_template_costs(WarpTask& task, const std::vector<float>& chance, size_t step);

// Lets the speaker of single frames' states repeat words or beginnings of them, and fall silent
// within.
void let_stutter(WarpTask& task, const std::vector<float>& chance,
                 const std::vector<SoundState>& states);

struct CoarseWay {
  std::vector<int32_t> way;  // about which state each recorded frame is; empty: there is no way
  double cost = 0;           // per recorded frame
};
// Means of some frames against means of as many states of a word: at most 20 million comparisons.
CoarseWay warp_coarsely(const SoundPair& pair, const std::vector<SoundState>& states);

struct SoundModel {
  std::vector<float> mean;                                    // feature_count a kind
  std::vector<float> inverse_variance;                        // the same
  std::vector<float> constant;                                // a kind: half the mean log variance
  std::vector<float> silence_mean, silence_inverse_variance;  // of frames left out
  float silence_constant = 0;
};

// What a first guess knows. `way` gives the state of each recorded frame, negative for none;
// `chance` how likely each is speech.
struct Hearing {
  const std::vector<SoundState>& states;
  const std::vector<int32_t>& way;
  const std::vector<float>& chance;
  uint32_t kinds = 0;
};

// Where there are few frames means are held to the template's, seen through a line from its
// features to the recording's, and variances to those of all kinds together (maximum a posteriori:
// Gauvain & Lee 1994, section III).
SoundModel learn_sounds(const Features& spoken, const Features& recorded, const Hearing& hearing);

// Turns and scales the features of both so that deviations from the model's means are independent
// and of variance 1. The model is of no use afterwards: learn anew.
void whiten(Features& spoken, Features& recorded, const Hearing& hearing, const SoundModel& model);

// Minus the log likelihood of a frame, over the number of features and without the constant that
// all models share; about 1/2 plus the kind's `constant` where the model is right.
float sound_cost(const SoundModel& model, uint32_t kind, const float* frame);
float silence_cost(const SoundModel& model, const float* frame);
float nearest_cost(const SoundModel& model, const float* frame);  // of the likeliest kind

}  // namespace wellspring::avatar
