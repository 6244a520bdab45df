// SPDX-License-Identifier: Apache-2.0
// What a frame of speech sounds like, as numbers that resemble each other for the same sound of
// different voices: mel-frequency cepstra and their slopes (Davis & Mermelstein 1980; Furui 1986).
#pragma once
#include <vector>

#include "avatar/speech/sound_file.h"

namespace wellspring::avatar {

inline constexpr int cepstra = 13;                 // the zeroth is loudness
inline constexpr int feature_count = 2 * cepstra;  // and the slopes of all of them
inline constexpr double feature_hop = 0.01;        // seconds from frame to frame
inline constexpr float quietest_speech = -55;      // dB of Features::loudness; less is nothing

struct Features {
  std::vector<float> values;    // feature_count a frame, frame after frame
  std::vector<float> loudness;  // of each frame: mean level of its bands, dB
  size_t size() const { return loudness.size(); }
  const float* frame(size_t i) const { return &values[i * feature_count]; }
  float* frame(size_t i) { return &values[i * feature_count]; }
};

// `samples` at `rate` Hz; frame i looks at 25 ms around i * feature_hop. Frames are as many as hops
// fit into the sound, at least one.
Features make_features(const std::vector<float>& samples, int rate);

// How likely each frame is speech, 0 to 1, from its loudness: two bells, of pauses and of speech,
// fitted to the sound by expectation maximisation. A sound of even loudness is all speech.
std::vector<float> speech_chance(const Features& features);
// Frames that are more likely speech; gaps and bursts shorter than 30 ms are smoothed over.
std::vector<bool> find_speech(const Features& features);

// Shifts and scales every feature so that it has mean 0 and variance 1 over the frames of `speech`.
void normalise(Features& features, const std::vector<bool>& speech);

}  // namespace wellspring::avatar
