// SPDX-License-Identifier: Apache-2.0
// What a curator may say of a kiosk: `kiosks` of exhibit.json, all of it optional but the name.
#pragma once
#include <string>

namespace wellspring::show {

// Seconds that a kiosk waits; what they decide: show/kiosk/stage.h.
struct KioskTimes {
  double hold_person = 2;       // a head counts as there after it was last seen
  double sleep_after = 30;      // without motion
  double leave_after = 6;       // of who is engaged: without a head or a touch
  double leave_untouched = 45;  // where no camera sees the guest: without a touch
  double leave_playing = 90;    // likewise while something plays
  double farewell = 6;          // its length
  double sleep_latest = 20;     // from its beginning, where nothing moves after it
};

// Of the lit part of a screen, in metres; 0: unknown.
struct ScreenSize {
  float width = 0, height = 0;
  bool known() const { return width > 0 && height > 0; }
};

struct KioskSettings {
  std::string name;       // as its page and its cameras say it
  std::string viewpoint;  // where its screen is a window; empty: the storyteller's for kiosks
  std::string teller;     // a storyteller's id: who comes there; empty: whoever is there
  float volume = 1;       // 0 to 1
  ScreenSize screen;      // known: its picture follows the head of its guest
  KioskTimes times;
};

}  // namespace wellspring::show
