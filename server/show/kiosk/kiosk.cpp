// SPDX-License-Identifier: Apache-2.0
#include "show/kiosk/kiosk.h"

#include <algorithm>
#include <cmath>

#include "show/storyteller/audience.h"

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

namespace {

constexpr float near_zone = 2.5f;                    // metres from the screen: who is there watches
constexpr float found_after = 0.5f, lost_after = 1;  // seconds: cameras lose heads for moments
// Metres that a head moves before it counts: cameras are less sure of its distance.
constexpr vec3 slack{0.03f, 0.03f, 0.06f};
// Shares of half the picture that what is far away shifts at most: what the viewpoint shows in its
// middle stays well in the picture.
constexpr float most_shift = 0.5f;
constexpr float nearest = 0.75f, farthest = 1.25f;  // shares of the distance at rest
constexpr float most_aside = 0.4f;                  // metres
constexpr float least_distance = 0.2f;              // metres of a head from the screen

constexpr float smooth_seconds = 0.35f;  // in which it arrives, nearly
constexpr float most_speed = 0.5f;       // metres a second
constexpr float arrived = 2e-4f;         // metres: less than a pixel

}  // namespace

float picture_height(const ScreenSize& screen, const View& rest) {
  if (!screen.known()) return 2 * viewing_distance * rest.tan_half_fov;
  return std::max(screen.height, screen.width * float(rest.height) / float(rest.width));
}

float rest_distance(const ScreenSize& screen, const View& rest) {
  if (!screen.known()) return viewing_distance;
  return 0.5f * picture_height(screen, rest) / rest.tan_half_fov;
}

vec3 place_of_head(vec3 head, const ScreenSize& screen, const View& rest) {
  if (!is_finite(head)) return vec3(0);
  const float distance = rest_distance(screen, rest);
  const float away = std::max(head.z, least_distance);
  const vec2 most =
      most_shift * rest.tan_half_fov * vec2(float(rest.width) / float(rest.height), 1);
  const vec2 slope = glm::clamp(vec2(head) / away, -most, most);
  const float depth = std::clamp(away, nearest * distance, farthest * distance);
  vec2 aside = slope * depth;
  if (const float length = glm::length(aside); length > most_aside) aside *= most_aside / length;
  return {aside, depth - distance};
}

void watch_heads(WindowEye& eye, std::span<const vec3> heads, const ScreenSize& screen,
                 const View& rest, float dt) {
  int watching = 0;
  vec3 head(0);
  for (vec3 one : heads)
    if (one.z < near_zone && ++watching == 1) head = one;
  watching = std::min(watching, 2);
  eye.since = watching == eye.watching ? eye.since + dt : 0;
  eye.watching = watching;
  if (watching > 1 || (watching == 0 && eye.since >= lost_after)) eye.follows = false;
  if (watching == 1 && !eye.follows && eye.since >= found_after)
    eye.follows = true, eye.head = head;
  if (watching == 1 && eye.follows) {
    const vec3 off = head - eye.head;
    const float times = glm::length(off / slack);
    if (times > 1) eye.head += off * (1 - 1 / times);
  }
  eye.aim = eye.follows ? place_of_head(eye.head, screen, rest) : vec3(0);
}

void move_eye(WindowEye& eye, float dt) {
  if (!(dt > 0)) return;
  const float rate = 2 / smooth_seconds, most = most_speed * smooth_seconds;
  vec3 off = eye.place - eye.aim;
  if (const float length = glm::length(off); length > most) off *= most / length;
  // The spring's exact motion towards the aim, or towards a place so near that it stays slow.
  const vec3 towards = eye.place - off, pull = (eye.speed + rate * off) * dt;
  const float left = std::exp(-rate * dt);
  eye.place = towards + (off + pull) * left;
  eye.speed = (eye.speed - rate * pull) * left;
  if (glm::length(eye.place - eye.aim) < arrived && glm::length(eye.speed) < rate * arrived)
    eye.place = eye.aim, eye.speed = vec3(0);
}

View through_window(const View& rest, const ScreenSize& screen, vec3 place) {
  if (!screen.known() || place == vec3(0)) return rest;
  const float distance = rest_distance(screen, rest),
              away = std::max(distance + place.z, 0.1f * distance);
  View view = rest;
  view.position += rest.right * place.x + rest.up * place.y - rest.forward * (away - distance);
  view.tan_half_fov = rest.tan_half_fov * distance / away;
  view.middle = vec2(place) / -away;
  return view;
}

namespace {

constexpr uint64_t unseen_guest = 0xffffffff;  // no camera's number is in it

bool sees(const Eye& eye, double now) {
  const CameraState camera = eye.seen.camera;
  return now - eye.received <= observation_lifetime &&
         (camera == CameraState::good || camera == CameraState::slow);
}

}  // namespace

void step_kiosk(Kiosk& kiosk, const KioskInput& input, const std::vector<Eye>& eyes,
                const View& window, double now) {
  kiosk.audience = input.closed
                       ? Audience{}
                       : gather_audience(eyes, kiosk.settings.name, window, now, kiosk.audience,
                                         rest_distance(kiosk.settings.screen, window));
  kiosk.showing = input.showing;
  StageInput stage;
  stage.camera = std::any_of(eyes.begin(), eyes.end(), [&](const Eye& eye) {
    return eye.kiosk == kiosk.settings.name && sees(eye, now);
  });
  stage.motion = kiosk.audience.state != Presence::absent;
  // Who holds something up may hide their face with it.
  stage.head = kiosk.audience.state == Presence::person || kiosk.audience.holding;
  stage.touched = input.touched;
  stage.busy = input.busy;
  stage.playing = input.playing;
  stage.greeted = kiosk.visit.greeted;
  stage.closed = input.closed;
  const Stage before = kiosk.stage.now;
  const Stage stage_now = step_stage(kiosk.stage, kiosk.settings.times, stage, now);
  kiosk.changed = stage_now != before;
  if (!kiosk.changed) return;
  if (!is_visit(stage_now)) kiosk.visit = {};
  else if (!is_visit(before)) kiosk.visit.began = now;
}

std::vector<Guest> guests_of(const Kiosk& kiosk, const View& window) {
  std::vector<Guest> guests = kiosk.audience.guests;
  const StageState& stage = kiosk.stage;
  if (guests.empty() && has_guest(stage.now) && stage.last_touch > stage.last_head) {
    Guest& guest = guests.emplace_back();
    guest.id = unseen_guest;
    guest.kiosk = true;
    guest.head = window.position;
  }
  return guests;
}

bool turns_pages(Showing showing) {
  return showing == Showing::book || showing == Showing::topics || showing == Showing::partners ||
         showing == Showing::slides;
}

EyeNeeds needs_of(const Kiosk& kiosk, bool here, bool page) {
  const Stage stage = kiosk.stage.now;
  const bool met = stage == Stage::engaged || (stage == Stage::person && kiosk.visit.greeted);
  return {stage != Stage::sleep, here && met, page && has_guest(stage)};
}

}  // namespace wellspring::show
