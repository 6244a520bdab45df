// SPDX-License-Identifier: Apache-2.0
// A kiosk's screen as a window: what is behind it is seen from where the head before it is, so it
// shifts as the head moves, while the window's frame stays (Kooima, "Generalized Perspective
// Projection", 2008). Places before the screen are metres from its middle: to the right, up, away
// from it.
#pragma once
#include <span>

#include "show/exhibit/kiosk_settings.h"
#include "world/view.h"

namespace wellspring::show {

// Where a page's picture is seen from. A plain value.
struct WindowEye {
  vec3 place{0};         // metres to the right of, above and behind the kiosk's viewpoint
  vec3 speed{0};         // metres a second
  vec3 aim{0};           // where it glides to, as `place`
  vec3 head{0};          // that is followed, before the screen
  bool follows = false;  // a head
  int watching = 0;      // heads near by: 0, 1, 2 or more
  float since = 0;       // seconds for which there have been as many
  bool operator==(const WindowEye&) const = default;
};

// Height of the picture, which covers the screen, in metres. Of a screen of unknown size: as high
// as seen from viewing_distance.
float picture_height(const ScreenSize& screen, const View& rest);
// How far before the screen the picture of the viewpoint is right: `rest`.
float rest_distance(const ScreenSize& screen, const View& rest);
// The place that a head's picture is seen from, as WindowEye::place. In the head's direction from
// the middle of the screen, but no farther aside or away than a visitor's eyes can bear.
vec3 place_of_head(vec3 head, const ScreenSize& screen, const View& rest);

// Sets `aim`: after the one head that is near; back to rest for none and for several, who cannot
// all be right. Small motions of a head, which may be noise, are none.
void watch_heads(WindowEye& eye, std::span<const vec3> heads, const ScreenSize& screen,
                 const View& rest, float dt);
// Towards `aim`, without jumps of place or speed: a critically damped spring of limited speed.
// Stands still where it arrives. dt: seconds, 0 or more.
void move_eye(WindowEye& eye, float dt);

// What is seen through the screen from that place; `rest` where it is 0.
View through_window(const View& rest, const ScreenSize& screen, vec3 place);

}  // namespace wellspring::show
