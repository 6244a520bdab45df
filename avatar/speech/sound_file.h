// SPDX-License-Identifier: Apache-2.0
// Reads recordings (WAV, FLAC, OGG, MP3 and what else libsndfile reads), and writes 16-bit WAV.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace wellspring::avatar {

struct Sound {
  int rate = 22050;            // samples a second
  std::vector<float> samples;  // mono, -1 to 1; channels are averaged
};

inline constexpr double longest_recording = 1200;  // seconds; longer recordings are refused

// Reads a file. Throws LoadError naming the file: missing, no regular file, no sound that can be
// read, cut off within, empty, longer than longest_recording, rates outside of 4 to 192 kHz.
// Samples that are not numbers are silence.
Sound load_sound(const std::string& file);

// Makes the whole file in memory, mono.
std::vector<uint8_t> encode_wav(const std::vector<int16_t>& pcm, int rate);

// Resamples to another rate by a windowed sinc (Hann, 16 zero crossings each side), low-pass if the
// rate goes down.
std::vector<float> resample(const std::vector<float>& samples, int from, int to);
// Convert samples; they are exact inverses but for samples louder than 1.
std::vector<int16_t> to_pcm(const std::vector<float>& samples);
std::vector<float> from_pcm(const std::vector<int16_t>& pcm);

}  // namespace wellspring::avatar
