// SPDX-License-Identifier: Apache-2.0
// One kiosk of the house: a screen and the cameras beside it, which belong together by their name.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/kiosk/holding.h"
#include "show/storyteller/audience.h"
#include "world/view.h"

namespace wellspring::show {

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
// A guest is gone without a head for hold_person, or for leave_after while engaged, and without a
// touch meanwhile. A guest who touches where no camera has a head, or none works, is gone without
// touches for leave_untouched, while something plays leave_playing. All are gone when the house
// closes.

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
  double time = 0;   // time of the last step
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

// A kiosk's screen as a window: what is behind it is seen from where the head before it is, so it
// shifts as the head moves, while the window's frame stays (Kooima, "Generalized Perspective
// Projection", 2008). Places before the screen are metres from its middle: to the right, up, away
// from it.

// Holds the place that a page's picture is seen from. It is a plain value.
struct WindowEye {
  vec3 place{0};         // metres to the right of, above and behind the kiosk's viewpoint
  vec3 speed{0};         // metres a second
  vec3 aim{0};           // place to which it glides, as `place`
  vec3 head{0};          // head that it follows, before the screen
  bool follows = false;  // a head
  int watching = 0;      // heads near by: 0, 1, 2 or more
  float since = 0;       // seconds for which there have been as many
  bool operator==(const WindowEye&) const = default;
};

// Returns the height of the picture, which covers the screen, in metres. A screen of unknown size
// is taken to be as high as seen from viewing_distance.
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

// Returns the view through the screen from that place; `rest` if it is 0.
View through_window(const View& rest, const ScreenSize& screen, vec3 place);

// Holds what is known of the guests of one visit; it is forgotten when the visit ends.
struct KioskVisit {
  double began = 0;  // show time
  bool greeted = false;
  std::vector<std::string> heard;  // ids of the stories told to them
  std::string gestured_story;      // id of the last that was asked for by a gesture
  HoldingTalk talk;                // about what they hold up
  bool operator==(const KioskVisit&) const = default;
};

struct Kiosk {
  KioskSettings settings;
  Audience audience;  // people before its own cameras
  StageState stage;
  bool changed = false;             // its stage did, in the last step
  Showing showing = Showing::well;  // shown by its page
  KioskVisit visit;
  HeldObject held;  // shown on its pages
  std::vector<std::pair<uint64_t, std::string>>
      gestures;                 // last tick's gestures of its guests, by their ids
  std::string gesture;          // the last that was handed to its page
  uint32_t gesture_number = 0;  // number of that one; 0: none yet
  std::string message;          // the last that its pages were sent
};

// Holds what its page says.
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

// Says what its cameras are to tell. `here`: the storyteller is; `page`: there is one.
EyeNeeds needs_of(const Kiosk& kiosk, bool here, bool page);

}  // namespace wellspring::show
