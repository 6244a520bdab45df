// SPDX-License-Identifier: Apache-2.0
#include "show/moving/play.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

double time_of(const ExhibitAnimation& animation, const Play& play, double now) {
  if (animation.start == ExhibitAnimation::Start::loop)
    return animation.seconds > 0 ? std::fmod(std::max(now, 0.0), animation.seconds) : 0;
  const double way = now - play.since;
  return std::clamp(play.on ? play.from + way : play.from - way, 0.0, animation.seconds);
}

bool is_running(const ExhibitAnimation& animation, const Play& play, double now) {
  if (animation.start == ExhibitAnimation::Start::loop) return true;
  return now - play.since < (play.on ? animation.seconds - play.from : play.from);
}

void set_on(const ExhibitAnimation& animation, bool on, double now, Play& play) {
  if (on == play.on) return;
  play = {on, time_of(animation, play, now), now};
}

}  // namespace wellspring::show
