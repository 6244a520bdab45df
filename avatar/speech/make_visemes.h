// SPDX-License-Identifier: Apache-2.0
// From the sounds of a speech to the mouth of its speaker over time, once a speech.
//
// Co-articulation. Every phoneme has a shape and a share: bilabials and labiodentals keep all of
// the mouth, the tongue's consonants (d, k, n, ...) leave most of it to the vowels around them,
// the coming vowel more than the past one (look-ahead, Pelachaud, Badler, Steedman 1996, section
// 4; the shares stand for the dominance of Cohen & Massaro 1993). Diphthongs are two shapes or
// three. A held shape is reached and left by a smooth step, so weights have no corners.
#pragma once
#include <vector>

#include "avatar/speech/mouth_shapes.h"
#include "avatar/speech/visemes.h"

namespace wellspring::avatar {

// A phoneme as the mouth sees it.
struct MouthSound {
  double begin = 0, end = 0;
  std::vector<MouthShape> shapes;  // none: keeps on its way to the next (h, glottal stop)
  bool pause = false;
};

// `sounds` in order of time. Sounds shorter than 15 ms are passed over, but for closures.
VisemeTrack make_visemes(const std::vector<MouthSound>& sounds);

}  // namespace wellspring::avatar
