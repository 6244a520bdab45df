// SPDX-License-Identifier: Apache-2.0
#include "show/answer/kiosk_window.h"

#include "show/kiosk/screen_window.h"
#include "show/state/in_view.h"

namespace wellspring::show {

namespace {

constexpr float wall_distance = 0.2f;  // metres that an eye keeps from walls

bool stays(const Show& show, const Kiosk& kiosk, const VisitorPlace& place) {
  return place.viewpoint == kiosk_viewpoint(show, kiosk.settings.name) && place.move == vec3(0) &&
         place.velocity == vec3(0) && place.tour.state == TourRide::State::none;
}

// So much of a step from there is free.
vec3 free_step(const World& world, vec3 from, vec3 step) {
  const float length = glm::length(step);
  if (!(length > 0)) return step;
  const Hit hit = world.intersect({from, 0, step / length, length + wall_distance});
  return hit.valid() ? step * (std::max(hit.t - wall_distance, 0.0f) / length) : step;
}

}  // namespace

int kiosk_viewpoint(const Show& show, const std::string& name) {
  const Exhibit& exhibit = show.exhibit;
  const StorytellerPlace* teller = storyteller_of(show, show.teller);
  for (const KioskSettings& kiosk : exhibit.kiosks) {
    if (kiosk.name != name) continue;
    if (const int own = find_viewpoint(exhibit, kiosk.viewpoint); own >= 0) return own;
    const int index = find_storyteller(exhibit, kiosk.teller);
    if (index >= 0) teller = &exhibit.storytellers[size_t(index)];
  }
  return teller ? teller->kiosk_viewpoint : exhibit.start;
}

View kiosk_window(const Show& show, const std::string& kiosk) {
  const Viewpoint& at = show.exhibit.viewpoints[size_t(kiosk_viewpoint(show, kiosk))].view;
  int width = 1600, height = 900;
  if (const Kiosk* found = find_kiosk(show, kiosk); found && found->settings.screen.known()) {
    const ScreenSize& screen = found->settings.screen;
    width = int(1000 * screen.width), height = int(1000 * screen.height);
  }
  return make_view(show.exhibit.scene, at, width, height);
}

void look_through(const Show& show, Visitor& page, float dt) {
  const Kiosk* kiosk = kiosk_of(show, page);
  if (!kiosk || !kiosk->settings.screen.known()) return;
  const ScreenSize& screen = kiosk->settings.screen;
  std::vector<vec3> heads;
  if (stays(show, *kiosk, page.place) && !turns_pages(kiosk->showing)) {
    const View window = kiosk_window(show, kiosk->settings.name);
    for (const Guest& guest : kiosk->audience.guests) {
      const vec3 off = guest.head - window.position;
      heads.push_back({dot(off, window.right), dot(off, window.up),
                       rest_distance(screen, window) - dot(off, window.forward)});
    }
  }
  const View rest = rest_view(show, page);
  WindowEye& eye = page.window;
  watch_heads(eye, heads, screen, rest, dt);
  const vec3 step = through_window(rest, screen, eye.aim).position - rest.position,
             free = free_step(*show.world, rest.position, step);
  if (free != step) eye.aim *= glm::length(free) / glm::length(step);
  move_eye(eye, dt);
}

}  // namespace wellspring::show
