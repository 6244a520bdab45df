// SPDX-License-Identifier: Apache-2.0
// Who stands before a kiosk: the newest observation of each of its cameras, placed into the
// exhibit's world.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "avatar/mind/storyteller.h"
#include "wire/link.h"
#include "wire/messages.h"
#include "world/view.h"

namespace wellspring::show {

// One kiosk camera, connected or lost.
struct Eye {
  std::shared_ptr<Link> link;  // closed: it has gone, and may come back
  Observation seen;
  double received = -1e9;   // show time of the newest observation
  double camera_since = 0;  // show time from which its camera is as it is
  uint64_t observations = 0, refused = 0;
  uint32_t number = 1;    // 1, 2, ...; stays as it is while other cameras come and go
  double gone = -1;       // show time at which a closed link was noticed; -1: it is not
  std::string kiosk{};    // whose it is
  std::string ordered{};  // the last order it was sent (EyeOrder)
};

// Whom a camera's person is taken for.
struct KnownPerson {
  uint64_t person = 0;         // as place_person() numbers it
  uint64_t guest = 0;          // Guest::id
  double since = 0, seen = 0;  // show time: first, last
};

struct Audience {
  Presence state = Presence::absent;
  std::vector<Guest> guests;  // kiosk guests, nearest first
  std::vector<KnownPerson> known;
  float nearest = 0;  // metres of the first from the screen; 0: there is none
  float aside = 0;    // metres right of the screen's middle, of that one
  std::optional<CalibrationStep> calibration;  // step of a camera that is being set up
  std::optional<Holding> holding;              // object held to a camera
  // Place on the screen that the nearest who points is pointing at, metres right of and above its
  // middle.
  std::optional<vec2> points_at;
};

// Distance from the screen at which the picture's camera is where the visitor's eyes are, where
// the size of the screen is unknown.
inline constexpr float viewing_distance = 0.6f;
// Observations older than this count no more: the camera or its program is gone.
inline constexpr double observation_lifetime = 2;

// A person before the screen as somebody in the exhibit: the screen is a window at `kiosk_view`,
// and the person stands as far behind it as before the real one. `eye`: its camera's number;
// `away`: from where before the screen the view is seen.
Guest place_person(const Person& person, const View& kiosk_view, uint32_t eye,
                   float away = viewing_distance);
// Gathers what the cameras of one kiosk see. A person whom several of them see at one place is one
// guest, with the number under which they were known first, and keeps it while one camera or
// another sees them. `before`: the last answer.
Audience gather_audience(const std::vector<Eye>& eyes, const std::string& kiosk,
                         const View& kiosk_view, double now, const Audience& before = {},
                         float away = viewing_distance);

}  // namespace wellspring::show
