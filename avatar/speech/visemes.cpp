// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/visemes.h"

#include <algorithm>
#include <cmath>

namespace wellspring::avatar {

const std::array<const char*, viseme_count> viseme_names = {
    "sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou"};

VisemeWeights eval_visemes(const VisemeTrack& track, double time) {
  const auto& keys = track.keys;
  if (keys.empty() || std::isnan(time)) {
    VisemeWeights rest{};
    rest[size_t(Viseme::sil)] = 1;
    return rest;
  }
  auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                [](double t, const VisemeKey& key) { return t < key.time; });
  if (after == keys.begin()) return keys.front().weights;
  if (after == keys.end()) return keys.back().weights;
  const VisemeKey &a = *(after - 1), &b = *after;
  float x = float((time - a.time) / (b.time - a.time));
  x = std::clamp(x * x * (3 - 2 * x), 0.0f, 1.0f);
  VisemeWeights weights;
  for (size_t i = 0; i < viseme_count; i++)
    weights[i] = std::clamp(a.weights[i] + (b.weights[i] - a.weights[i]) * x, 0.0f, 1.0f);
  return weights;
}

}  // namespace wellspring::avatar
