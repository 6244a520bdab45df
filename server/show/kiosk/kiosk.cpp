// SPDX-License-Identifier: Apache-2.0
#include "show/kiosk/kiosk.h"

#include <algorithm>

#include "show/kiosk/screen_window.h"

namespace wellspring::show {

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
  stage.head = kiosk.audience.state == Presence::person;
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
