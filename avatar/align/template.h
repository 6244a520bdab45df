// SPDX-License-Identifier: Apache-2.0
// The spoken text as the row of templates that a recording is warped onto.
#pragma once
#include <cstdint>
#include <vector>

#include "avatar/align/time_warp.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

// A piece of a phoneme.
struct SoundState {
  uint32_t kind = 0;             // pieces of the same kind of sound share a model
  uint32_t phoneme = 0;          // index into Speech::phonemes
  size_t frame = 0, frames = 1;  // of the spoken text's features
  bool word_begins = false;
};

// Every phoneme that is no pause, frame by frame (pieces = 0) or in up to `pieces` of at least two
// frames each. `frame_count` is the number of features of the spoken text.
std::vector<SoundState> make_states(const Speech& spoken, size_t frame_count, size_t pieces);

// Gives the states of phonemes of the same name (length and stress apart), by their place in the
// phoneme (first, middle, last), the same kind. Returns the number of kinds.
uint32_t number_kinds(const Speech& spoken, std::vector<SoundState>& states);

// Where something may be left out: before the states that begin a word, and at the end; `blocks`:
// silence also before every other phoneme, where a speaker's voice fails him.
std::vector<WarpGap> gaps_before(const std::vector<SoundState>& states, bool blocks = false);

// Stuttering: after each of its phonemes, the last too, a word may begin again, or the one before
// it (Costs of either are added to every one further back.)
std::vector<std::vector<WarpReturn>> find_returns(const std::vector<SoundState>& states, float cost,
                                                  float cost_of_word);

}  // namespace wellspring::avatar
