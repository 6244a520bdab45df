// SPDX-License-Identifier: Apache-2.0
// The silence of p, t and k belongs to them.
#pragma once
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

// eSpeak NG's voiceless stops begin with their burst; the closure before it, when the lips of a p
// are shut and nothing is heard, counts as the end of the sound before. Moves their begin to where
// the silence begins, and that of a stop after a pause by usual_closure into the pause. To be
// called before words are given their times.
void include_closures(Speech& speech);

inline constexpr double usual_closure = 0.04;  // seconds; where it cannot be heard

}  // namespace wellspring::avatar
