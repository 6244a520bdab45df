// SPDX-License-Identifier: Apache-2.0
// Times what happens while a line of a story is told: the marks of its text at the times of the
// words they stand before. Names are those of the storyteller and kiosk paper: a TimelineAction
// says when, an ActionEvent what. A timeline is a value; a cursor runs through it, so that the same
// line gives the same events in the same order whatever the steps of time.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "avatar/body/hold.h"
#include "avatar/speech/speech.h"
#include "avatar/story/story_script.h"
#include "base/vec.h"

namespace wellspring::avatar {

// Holds what a story asks of the storyteller's body at this moment: the first layer of its emotions
// and motions, the same every time the story is told. Places are the world's.

struct StoryCue {
  // These hold until the story says otherwise.
  std::string emotion;       // joy sadness anger fear disgust surprise; empty: none
  float emotion_weight = 0;  // 0..1
  std::optional<vec3> look;  // place looked at instead of the guest
  std::optional<vec3>
      point;  // place the nearer hand is held out at; it is looked at, too, unless `look` differs
  HeldThing held;
  // These begin in this tick.
  std::string gesture;       // name of the library; empty: none begins
  float gesture_weight = 1;  // 0..1, how large
  float gesture_lead = 0;    // seconds until the word that its stroke belongs to
  float beat = 0;            // 0..1: an emphasised word begins (brows and head)
  uint32_t seed = 0;         // seed of the story: chance in telling it starts from here
};

struct ActionEvent {
  StoryMarkKind kind = StoryMarkKind::mark;
  std::string name;
  float weight = 1;
  float lead = 0;  // seconds from the event to the word it belongs to
  PieceMark piece{};
};

struct TimelineAction {
  double time = 0;  // seconds from the line's first sample; below 0: in the breath before
  ActionEvent event;
};

struct Timeline {
  std::vector<TimelineAction> actions;  // in order of time
};

// Hands and eyes need a moment: the stroke of a gesture is to meet the word (its clip has that
// time).
inline constexpr double point_lead = 0.5, look_lead = 0.25, hold_lead = 1, earliest_action = -0.2;

// Makes a timeline. `speech` gives the times of words; without one, `seconds` are shared out by
// characters.
Timeline make_timeline(const StoryLine& line, const Speech* speech, double seconds);

// Returns events with time <= `now` that `cursor` has not passed yet, and moves it on. The pointers
// are into `timeline`.
std::vector<const ActionEvent*> advance_timeline(const Timeline& timeline, size_t& cursor,
                                                 double now);

// Holds what a story keeps between its events: names, not yet places.
struct StoryHold {
  std::string emotion;
  float emotion_weight = 0;
  std::string look, point;  // names; empty: the visitor, nothing
  std::string prop;         // thing in a hand; empty: nothing
};
void hold(StoryHold& held, const ActionEvent& event);
// Returns what holds before line `index`, after all lines before it.
StoryHold hold_before(const std::vector<StoryLine>& lines, size_t index);

}  // namespace wellspring::avatar
