// SPDX-License-Identifier: Apache-2.0
#include "show/kiosk/stage.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

namespace {

constexpr double rounding = 1e-6;  // sums of times carry it; a tick of the clock must not decide

bool is_gone(const StageState& state, const KioskTimes& times, const StageInput& input) {
  if (input.closed) return true;
  const double noticed = std::max(state.last_head, state.last_touch);
  const double longest = input.playing ? times.leave_playing : times.leave_untouched;
  if (state.time - noticed > longest + rounding) return true;
  // Who touches without a head is beside the camera's view: it cannot say that they have left.
  const bool seen = input.camera && state.last_head >= state.last_touch - times.hold_person;
  const double hold = state.now == Stage::engaged ? times.leave_after : times.hold_person;
  return seen && state.time - std::max(noticed, state.camera_since) > hold + rounding;
}

Stage next_stage(const StageState& state, const KioskTimes& times, const StageInput& input) {
  const bool comes = input.head || input.touched;
  const double lasted = state.time - state.since;
  switch (state.now) {
    case Stage::sleep:
      if (comes) return Stage::person;
      return input.motion ? Stage::awake : Stage::sleep;
    case Stage::awake: {
      if (comes) return Stage::person;
      if (input.closed) return Stage::sleep;
      const bool quiet = state.parted && state.last_motion <= state.since;
      double until = state.last_motion + times.sleep_after;
      if (quiet) until = std::min(until, *state.parted + times.sleep_latest);
      return state.time > until + rounding ? Stage::sleep : Stage::awake;
    }
    case Stage::person:
      if (input.busy || (input.touched && !input.camera)) return Stage::engaged;
      if (!is_gone(state, times, input)) return Stage::person;
      return input.greeted ? Stage::farewell : Stage::awake;
    case Stage::engaged: return is_gone(state, times, input) ? Stage::farewell : Stage::engaged;
    case Stage::farewell:
      if (comes) return Stage::person;
      if (lasted < times.farewell - rounding) return Stage::farewell;
      return state.last_motion > state.since ? Stage::awake : Stage::sleep;
  }
  return state.now;
}

}  // namespace

const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::sleep: return "sleep";
    case Stage::awake: return "awake";
    case Stage::person: return "person";
    case Stage::engaged: return "engaged";
    case Stage::farewell: return "farewell";
  }
  return "sleep";
}

Stage step_stage(StageState& state, const KioskTimes& times, const StageInput& said, double time) {
  if (!std::isfinite(time)) return state.now;
  StageInput input = said;
  if (input.closed) input.motion = input.head = input.touched = input.busy = false;
  state.time = std::max(state.time, time);
  if (input.camera && !state.camera) state.camera_since = state.time;
  state.camera = input.camera;
  if (input.motion || input.head || input.touched) state.last_motion = state.time;
  if (input.head) state.last_head = state.time;
  if (input.touched) state.last_touch = state.time;
  const Stage next = next_stage(state, times, input);
  if (next == state.now) return next;
  if (next == Stage::farewell) state.parted = state.time;
  else if (state.now != Stage::farewell || next != Stage::awake) state.parted.reset();
  state.now = next;
  state.since = state.time;
  return next;
}

}  // namespace wellspring::show
