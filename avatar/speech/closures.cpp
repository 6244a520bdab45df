// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/closures.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "avatar/speech/mouth_shapes.h"

namespace wellspring::avatar {

namespace {

constexpr double window = 0.0025;         // seconds
constexpr double quiet = 1e-4;            // of the loudest window's energy
constexpr double longest_closure = 0.15;  // seconds
constexpr double least_left = 0.02;       // seconds, of the sound before

bool is_voiceless_stop(const SpeechPhoneme& phoneme) {
  for (std::string_view stop : {"p", "t", "k", "c", "q", "ʈ", "ʔ"})
    if (std::string_view(phoneme.ipa).starts_with(stop)) return true;
  return false;
}

std::vector<double> window_energies(const Speech& speech) {
  size_t length = std::max<size_t>(1, size_t(window * speech.rate));
  std::vector<double> energy(speech.pcm.size() / length);
  for (size_t i = 0; i < energy.size(); i++)
    for (size_t k = i * length; k < (i + 1) * length; k++)
      energy[i] += double(speech.pcm[k]) * double(speech.pcm[k]);
  return energy;
}

}  // namespace

void include_closures(Speech& speech) {
  std::vector<double> energy = window_energies(speech);
  if (energy.empty()) return;
  double threshold = quiet * *std::max_element(energy.begin(), energy.end());
  double length = double(std::max<size_t>(1, size_t(window * speech.rate))) / speech.rate;
  for (size_t i = 1; i < speech.phonemes.size(); i++) {
    SpeechPhoneme &stop = speech.phonemes[i], &before = speech.phonemes[i - 1];
    if (!is_voiceless_stop(stop)) continue;
    double begin = stop.begin;
    if (is_pause(before.mnemonic)) {
      begin = std::max(before.begin, stop.begin - usual_closure);
    } else {
      double earliest = std::max(before.begin + least_left, stop.begin - longest_closure);
      // The window that the burst lies in is passed over.
      for (size_t k = std::min(size_t(stop.begin / length), energy.size());
           k-- > 0 && energy[k] <= threshold && double(k) * length >= earliest;)
        begin = double(k) * length;
    }
    stop.begin = before.end = std::min(begin, stop.begin);
  }
  std::erase_if(speech.phonemes, [](const SpeechPhoneme& phoneme) {
    return is_pause(phoneme.mnemonic) && phoneme.end <= phoneme.begin;
  });
}

}  // namespace wellspring::avatar
