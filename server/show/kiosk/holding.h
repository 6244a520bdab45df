// SPDX-License-Identifier: Apache-2.0
// Answers what a guest holds to a kiosk's camera: what the storyteller says to it, and where the
// kiosk's screen shows the object (Eissele, Sanftmann, Ertl: Interactively Refining
// Object-Recognition System, sections 4.2 and 5: messages to the user, models in pose). Plain
// values; times are show times in seconds, places are metres.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/storyteller/audience.h"
#include "world/view.h"

namespace wellspring::show {

// Holds what was said about it to the guests of one visit.
struct HoldingTalk {
  std::string seen;         // a hint or an object's id, as the camera says it
  double seen_since = 0;    // since when it says that
  std::string said;         // the last that was said, as `seen`
  double said_at = -1e9;    // when its sentence was begun
  std::string named;        // object whose title was said last
  double silent_since = 0;  // since when she has said nothing
  bool operator==(const HoldingTalk&) const = default;
};

// Says what the storyteller is to do now; both empty: nothing.
struct HoldingWords {
  LocalScript text;   // to be said
  std::string story;  // to be told: its id
};

inline constexpr double hint_settles = 1, name_settles = 0.4;  // seconds that it must be seen
inline constexpr double talk_pause = 5;     // seconds from one sentence to the next, and of silence
inline constexpr double repeat_pause = 20;  // before she says the same again
inline constexpr double story_pause = 4;    // an object is still held so long after it was named

// Chooses her words, calmly: a hint or a title that has been seen for a moment, while she says
// nothing, seldom the same again. Whoever still holds an object of the exhibit then is told its
// story, unless it is one of those `heard`. `talks`: she says something now.
HoldingWords choose_words(HoldingTalk& talk, const std::optional<Holding>& holding,
                          const Exhibit& exhibit, const std::vector<std::string>& heard, bool talks,
                          double now);

// Holds the object as the screen shows it.
struct HeldObject {
  int model = -1;         // index into ShowCast::held; -1: nothing is shown
  float size = 0;         // 0..1: it grows when it is seen, and shrinks when it is gone
  vec3 place{0};          // before the screen, as Holding::position
  quat turn{1, 0, 0, 0};  // from its own axes (+x right, +y up, +z its front) to the mirror's
  double time = -1e9;     // time of the last step
  bool operator==(const HeldObject&) const = default;
};

// Follows what is seen, smoothly. `model`: that of the object; -1: there is none.
void follow_held(HeldObject& held, int model, const std::optional<Holding>& holding, double now);

// Returns what takes the object's metres to the world before `view`. The screen is a mirror: the
// object is as far behind it as it is held before it, and moves with the hand; but writing on it
// stays legible. `away`: from where before the screen the view is seen.
mat4 place_held(const HeldObject& held, const View& view, float away);

}  // namespace wellspring::show
