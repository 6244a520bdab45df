// SPDX-License-Identifier: Apache-2.0
// One kiosk of the house: a screen and the cameras beside it, which belong together by their name.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "show/exhibit/kiosk_settings.h"
#include "show/kiosk/stage.h"
#include "show/storyteller/audience.h"

namespace wellspring::show {

// What is known of the guests of one visit, and forgotten when it ends.
struct KioskVisit {
  double began = 0;  // show time
  bool greeted = false;
  std::vector<std::string> heard;  // ids of the stories told to them
  std::string gestured_story;      // id of the last that was asked for by a gesture
  bool operator==(const KioskVisit&) const = default;
};

struct Kiosk {
  KioskSettings settings;
  Audience audience;  // of its own cameras
  StageState stage;
  bool changed = false;             // its stage, in the last step
  Showing showing = Showing::well;  // of its page
  KioskVisit visit;
  std::vector<std::pair<uint64_t, std::string>> gestures;  // of its guests, by their ids, last tick
  std::string gesture;                                     // the last that was handed to its page
  uint32_t gesture_number = 0;                             // of that one; 0: none yet
  std::string message;                                     // the last that its pages were sent
};

// What its page says.
struct KioskInput {
  bool touched = false, busy = false, playing = false;  // StageInput
  Showing showing = Showing::well;
  bool closed = false;  // the house
};
// One step. `eyes`: of all kiosks; `window`: where its screen is in the exhibit.
void step_kiosk(Kiosk& kiosk, const KioskInput& input, const std::vector<Eye>& eyes,
                const View& window, double now);

// Guests as the storyteller sees them: who touches but is seen by no camera stands where the
// picture is seen from.
std::vector<Guest> guests_of(const Kiosk& kiosk, const View& window);

// Whether a page that shows this turns its pages by gestures itself.
bool turns_pages(Showing showing);

// What its cameras are to tell. `here`: the storyteller is; `page`: there is one.
EyeNeeds needs_of(const Kiosk& kiosk, bool here, bool page);

}  // namespace wellspring::show
