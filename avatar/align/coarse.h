// SPDX-License-Identifier: Apache-2.0
// A recording and the text as it is synthesised, as features that can be compared, and the first,
// coarse way from one to the other.
#pragma once
#include "avatar/align/features.h"
#include "avatar/align/template.h"
#include "avatar/align/time_warp.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

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

}  // namespace wellspring::avatar
