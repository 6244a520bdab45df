// SPDX-License-Identifier: Apache-2.0
// How far a guest before a kiosk has come: asleep -> awake -> person -> engaged -> farewell ->
// asleep. A function of what cameras and touches say and of time alone. Source: the storyteller and
// kiosk paper's states; who leaves is its gap, filled here.
//
//   sleep, awake -> person   a head; a touch, of a guest whom no camera sees
//   person -> engaged        the page shows something, she tells, a tour goes; without a camera
//                            that works a touch is enough
//   person -> awake          gone, and was never greeted: has only walked by
//   person, engaged -> farewell   gone
//   farewell -> person       a head or a touch: the same visit goes on
//   farewell -> awake, sleep      its time is over; something moved meanwhile, or nothing
//
// Gone: no head for hold_person, or for leave_after while engaged, and no touch meanwhile. A guest
// who touches where no camera has a head, or none works, is gone without touches for
// leave_untouched, while something plays leave_playing. Where the house closes, all are gone.
#pragma once
#include <cstdint>
#include <optional>

#include "show/exhibit/kiosk_settings.h"

namespace wellspring::show {

enum class Stage : uint8_t { sleep, awake, person, engaged, farewell };
const char* to_string(Stage stage);

struct StageInput {
  bool camera = false;   // one at least says that it sees
  bool motion = false;   // something moves
  bool head = false;     // somebody is seen
  bool touched = false;  // the screen, since the last step
  bool busy = false;     // the guest does something: a book is open, a story told, a tour goes on
  bool playing = false;  // something goes on that needs no touches
  bool greeted = false;  // the guests of this visit have been
  bool closed = false;   // the house is: nobody is taken to be there, whatever else is said
};

// A plain value. Times are those of the steps.
struct StageState {
  Stage now = Stage::sleep;
  double since = 0;  // time of the last change
  double time = 0;   // of the last step
  double last_motion = -1e9, last_head = -1e9, last_touch = -1e9;
  double camera_since = -1e9;    // from when a camera sees
  std::optional<double> parted;  // when the farewell began that is going on or led here
  bool camera = false;           // in the last step
};

// One step at `time`, seconds on a clock; one that runs back counts as no time passed, one that is
// no number changes nothing. Returns state.now. A visit is from the change to `person` until that
// to `sleep` or `awake`.
Stage step_stage(StageState& state, const KioskTimes& times, const StageInput& input, double time);

// Somebody is taken to be there.
inline bool has_guest(Stage stage) { return stage == Stage::person || stage == Stage::engaged; }
inline bool is_visit(Stage stage) { return has_guest(stage) || stage == Stage::farewell; }

}  // namespace wellspring::show
