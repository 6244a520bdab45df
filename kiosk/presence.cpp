// SPDX-License-Identifier: Apache-2.0
#include "kiosk/presence.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

void gather(double& evidence, bool cue, double step, double enough) {
  evidence = std::clamp(evidence + (cue ? step : -step), 0.0, enough);
}

}  // namespace

Presence step_presence(PresenceState& state, const PresenceSettings& settings, double time,
                       bool moving, bool face) {
  if (!std::isfinite(time)) return state.now;
  if (!state.started) {
    state.started = true;
    state.since = state.last_time = time;
  }
  if (time < state.last_time) {  // the clock was set back: keep every age as it is
    double shift = time - state.last_time;
    state.since += shift;
    state.last_motion += shift;
    state.last_face += shift;
    state.last_time = time;
  }
  double step = std::min(time - state.last_time, settings.longest_step);
  state.last_time = time;
  gather(state.motion_evidence, moving, step, settings.wake_after);
  gather(state.face_evidence, face, step, settings.confirm_after);
  if (moving) state.last_motion = time;
  if (face) state.last_face = time;

  // Sums of frame times carry rounding; a tick of the clock must not decide.
  constexpr double rounding = 1e-6;
  const bool woken = state.motion_evidence >= settings.wake_after - rounding;
  const bool confirmed = state.face_evidence >= settings.confirm_after - rounding;
  const bool quiet = time - std::max(state.last_motion, state.last_face) > settings.hold_motion;

  Presence next = state.now;
  switch (state.now) {
    case Presence::absent:
      if (confirmed) next = Presence::person;
      else if (woken) next = Presence::motion;
      break;
    case Presence::motion:
      if (confirmed) next = Presence::person;
      else if (quiet) next = Presence::absent;
      break;
    case Presence::person:
      if (time - state.last_face > settings.hold_person)
        next = quiet ? Presence::absent : Presence::motion;
      break;
  }
  if (next != state.now) {
    state.now = next;
    state.since = time;
    if (next != Presence::person) state.face_evidence = 0;
    if (next == Presence::absent) state.motion_evidence = 0;
  }
  return state.now;
}

}  // namespace wellspring::kiosk
