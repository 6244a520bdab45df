// SPDX-License-Identifier: Apache-2.0
// From one picture at rest to the next, better one of the same view the eye is led gradually: a cut
// would be seen as a flicker.
#pragma once
#include "frame/tonemap.h"
#include "picture/keyframe.h"

namespace wellspring::show {

struct Fade {
  Image8 from;  // what was shown; empty: nothing fades
  View view;
  double began = 0;  // show time
};

// What the keyframe shows passes into what is shown from `time` on.
void begin_fade(const Keyframe& shown, double time, Fade& fade);
// How much of the newer picture is shown: 0 to 1; 1 of another view.
float fade_share(const Fade& fade, const View& view, double time);
// Mixes what was shown into a picture of its size, in display codes.
void mix_fade(const Fade& fade, float share, Image8& image);

}  // namespace wellspring::show
