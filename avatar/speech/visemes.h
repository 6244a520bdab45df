// SPDX-License-Identifier: Apache-2.0
// The mouth of a speaker over time: fifteen weights (the MPEG-4 set in Oculus' naming) that glide
// from one held shape to the next. make_visemes.h makes it from sounds.
//
// Laws, at every time: each weight in [0, 1]; their sum is 1, `sil` being the rest; a closure (p b
// m) holds PP = 1 from the beginning of its sound until it opens. Evaluation keeps no state, so it
// does not depend on the time step.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wellspring::avatar {

enum class Viseme : uint8_t { sil, PP, FF, TH, DD, kk, CH, SS, nn, RR, aa, E, ih, oh, ou };
inline constexpr size_t viseme_count = 15;
extern const std::array<const char*, viseme_count> viseme_names;  // as above, order of Rig::viseme

using VisemeWeights = std::array<float, viseme_count>;

struct VisemeKey {
  double time = 0;
  VisemeWeights weights{};
};

struct VisemeTrack {
  // Times increase strictly; before the first and after the last the weights are theirs.
  std::vector<VisemeKey> keys;
};

// Weights at `time`; an empty track and a time that is not a number are silence.
VisemeWeights eval_visemes(const VisemeTrack& track, double time);

}  // namespace wellspring::avatar
