// SPDX-License-Identifier: Apache-2.0
// Describes how a frame of speech sounds, by numbers that resemble each other for the same sound of
// different voices: mel-frequency cepstra and their slopes (Davis & Mermelstein 1980; Furui 1986).
#pragma once
#include <cstdint>
#include <vector>

#include "avatar/align/time_warp.h"
#include "avatar/speech/sound_file.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

inline constexpr int cepstra = 13;                 // the zeroth is loudness
inline constexpr int feature_count = 2 * cepstra;  // cepstra and their slopes
inline constexpr double feature_hop = 0.01;        // seconds from frame to frame
inline constexpr float quietest_speech = -55;      // dB of Features::loudness; less is no speech

struct Features {
  std::vector<float> values;    // feature_count a frame, frame after frame
  std::vector<float> loudness;  // mean level of each frame's bands, dB
  size_t size() const { return loudness.size(); }
  const float* frame(size_t i) const { return &values[i * feature_count]; }
  float* frame(size_t i) { return &values[i * feature_count]; }
};

// Makes features of `samples` at `rate` Hz; frame i looks at 25 ms around i * feature_hop. Frames
// are as many as hops fit into the sound, at least one.
Features make_features(const std::vector<float>& samples, int rate);

// Returns how likely each frame is speech, 0 to 1, by its loudness: two bells, of pauses and of
// speech, are fitted to the sound by expectation maximisation. A sound of even loudness is all
// speech.
std::vector<float> speech_chance(const Features& features);
// Finds the frames that are more likely speech; gaps and bursts shorter than 30 ms are smoothed
// over.
std::vector<bool> find_speech(const Features& features);

// Shifts and scales every feature so that it has mean 0 and variance 1 over the frames of `speech`.
void normalise(Features& features, const std::vector<bool>& speech);

// Turns the spoken text into the row of templates that a recording is warped onto.

// Holds a piece of a phoneme.
struct SoundState {
  uint32_t kind = 0;             // pieces of the same kind of sound share a model
  uint32_t phoneme = 0;          // index into Speech::phonemes
  size_t frame = 0, frames = 1;  // first frame and number of frames in the spoken text's features
  bool word_begins = false;
};

// Makes states of every phoneme that is no pause, frame by frame (pieces = 0) or in up to `pieces`
// pieces of at least two frames each. `frame_count` is the number of features of the spoken text.
std::vector<SoundState> make_states(const Speech& spoken, size_t frame_count, size_t pieces);

// Gives the states of phonemes of the same name (length and stress apart), by their place in the
// phoneme (first, middle, last), the same kind. Returns the number of kinds.
uint32_t number_kinds(const Speech& spoken, std::vector<SoundState>& states);

// Returns the gaps in which sounds may be left out: before the states that begin a word, and at the
// end; with `blocks` also silence before every other phoneme, for speakers whose voice fails them.
std::vector<WarpGap> gaps_before(const std::vector<SoundState>& states, bool blocks = false);

// Returns the ways back of a speaker who stutters: after each of its phonemes, the last too, a word
// may begin again at `cost`, or the word before it at `cost` + `cost_of_word`.
std::vector<std::vector<WarpReturn>> find_returns(const std::vector<SoundState>& states, float cost,
                                                  float cost_of_word);

}  // namespace wellspring::avatar
