// SPDX-License-Identifier: Apache-2.0
// Turns one frame into one observation: motion, faces, heads, bodies, hands, presence, what is
// held, in that order. It returns numbers and names only.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "kiosk/face/expression.h"
#include "kiosk/face/face_finder.h"
#include "kiosk/face/liveness.h"
#include "kiosk/frame/head.h"
#include "kiosk/gesture/gesture_model.h"
#include "kiosk/people.h"
#include "kiosk/tree/tree.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

// Decides between absent -> motion -> person and back, with evidence that must gather and holds
// that must run out, so that a flickering detector never makes the state flicker. Time is an
// argument: seconds, from the frames.

struct PresenceSettings {
  double wake_after = 0.4;     // seconds of movement before absent becomes motion
  double confirm_after = 0.5;  // seconds of a face before anything becomes person
  double hold_person = 2.0;    // seconds without a face before person is given up
  double hold_motion = 3.0;    // seconds without movement or face before motion becomes absent
  double longest_step = 0.25;  // seconds of evidence in one frame at most, however late it comes
};

struct PresenceState {
  Presence now = Presence::absent;
  double since = 0;  // time of the last change
  // Evidence in seconds: it grows with the time a cue is there, falls as fast while the cue is
  // away, and is never below 0.
  double motion_evidence = 0, face_evidence = 0;
  double last_time = 0, last_motion = -1e9, last_face = -1e9;
  bool started = false;
};

// Says what a frame shows of faces: `unsure` ones gather evidence, as it takes a moment to tell
// whether they live (kiosk/face/liveness.h), but nobody is there before one of them is a visitor's.
enum class FacesSeen : uint8_t { none, unsure, visitor };

// Takes one frame: `moving` as Motion says, `coming` if a body comes from afar, which is motion at
// once. A time that runs backwards (a file that starts again) counts as no time passed. Returns
// state.now.
Presence step_presence(PresenceState& state, const PresenceSettings& settings, double time,
                       bool moving, FacesSeen faces, bool coming = false);

// Filters a head's rotation, radians; docs/benchmarks/kiosk.eye.md compares it.
inline constexpr OneEuroSettings rotation_filter{0.6f, 6.f, 1.f};

struct ObserverSettings {
  Mount mount;
  FaceSettings face;
  MotionSettings motion;
  PeopleSettings people;
  PresenceSettings presence;
  LivenessSettings liveness;
  bool expression = false;  // estimate Person::expression; needs the networks' weights
  ExpressionSettings expressions;
  std::optional<RecognitionTree> station;   // objects that may be held; empty: none
  const GestureModels* gestures = nullptr;  // borrowed; null: hands are not followed
  bool bodies = false;                      // see bodies, also without a face, from afar
};

class Observer {
 public:
  // Throws LoadError when a cascade is missing.
  explicit Observer(const ObserverSettings& settings = {});
  ~Observer();
  // Takes every frame in order; about 10 ms for 640x480 on one core.
  Observation step(const GrayFrame& frame);
  // Says what is needed; the rest is not computed from the next frame on; at first all of it is.
  void need(const EyeNeeds& needs);
  // Notes that the camera gave nothing up to `time`: nobody is seen, and holds run out.
  Observation step_blind(double time);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
