// SPDX-License-Identifier: Apache-2.0
// absent -> motion -> person and back, with evidence that must gather and holds that must run out,
// so that a flickering detector never makes the state flicker. Time is an argument: seconds, from
// the frames.
#pragma once
#include "wire/messages.h"

namespace wellspring::kiosk {

struct PresenceSettings {
  double wake_after = 0.4;     // seconds of movement before absent becomes motion
  double confirm_after = 0.7;  // seconds of a face before anything becomes person
  double hold_person = 2.0;    // seconds without a face before person is given up
  double hold_motion = 3.0;    // seconds without movement or face before motion becomes absent
  double longest_step = 0.25;  // one frame is no more evidence than this, however late it comes
};

struct PresenceState {
  Presence now = Presence::absent;
  double since = 0;  // time of the last change
  // Evidence in seconds: grows with the time a cue is there, falls as fast while it is not, never
  // below 0.
  double motion_evidence = 0, face_evidence = 0;
  double last_time = 0, last_motion = -1e9, last_face = -1e9;
  bool started = false;
};

// One frame: `moving` as motion.h says, `face` as a face is followed. A time that runs backwards (a
// file that starts again) counts as no time passed. Returns state.now.
Presence step_presence(PresenceState& state, const PresenceSettings& settings, double time,
                       bool moving, bool face);

}  // namespace wellspring::kiosk
