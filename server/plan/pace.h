// SPDX-License-Identifier: Apache-2.0
// The server's rules of who gets which picture when, as far as they change how long visitors wait:
// show/draw/decide.h, show/draw/pace.cpp and show/draw/make_picture_job.cpp in plain numbers, for
// walkers who are all worth the same. Times are in seconds.
#pragma once

#include "base/layers.h"

namespace wellspring::plan {

struct KeyframePace {
  double scale = 1;   // its sides have so much
  double period = 0;  // until the next
};
// show::plan_keyframe: what a keyframe of scale `before` took, how many walk, and how long one may
// be used.
KeyframePace pace_keyframe(double seconds, int walkers, double before, double longest);

// Returns how long a page may use one keyframe (show::longest_period, show::finished_period): a
// page that draws by itself long while its visitor goes ahead, less in a turn. Near things
// and what they uncover are left out, as they depend on the exhibit.
double longest_use(bool local, bool turns);

// Returns the time that a picture gets for samples. `drawing`: what drawing one of its scale takes;
// `period`: until the next; `waiting`: how many want one; `least`, `most`: what a thousand samples
// and half a sample a pixel take.
double sampling_seconds(double drawing, double period, int waiting, int walkers, double least,
                        double most);

// Returns finished pictures a second for each of those who walk; `showing` is what one for each of
// them takes, warped and encoded.
double finished_rate(double showing);

}  // namespace wellspring::plan
