// SPDX-License-Identifier: Apache-2.0
// Who stands before the kiosks: the newest observation of every camera, placed into the exhibit's
// world.
#pragma once
#include <memory>
#include <vector>

#include "avatar/mind/storyteller.h"
#include "wire/link.h"
#include "wire/messages.h"
#include "world/view.h"

namespace wellspring {

// One connected kiosk camera.
struct Eye {
  std::shared_ptr<Link> link;
  Observation seen;
  double received = -1e9;  // show time of the newest observation
  uint64_t observations = 0, refused = 0;
};

struct Audience {
  Presence state = Presence::absent;
  std::vector<Guest> guests;  // kiosk guests, nearest first
};

// Distance from the screen at which the picture's camera is where the visitor's eyes are.
inline constexpr float viewing_distance = 0.6f;
// Observations older than this count no more: the camera or its program is gone.
inline constexpr double observation_lifetime = 2;

// A person before the screen as somebody in the exhibit: the screen is a window at `kiosk_view`,
// and the person stands as far behind it as before the real one.
Guest place_person(const Person& person, const View& kiosk_view, uint32_t eye_index);
Audience gather_audience(const std::vector<Eye>& eyes, const View& kiosk_view, double now);

}  // namespace wellspring
