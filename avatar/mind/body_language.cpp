// SPDX-License-Identifier: Apache-2.0
#include "avatar/mind/body_language.h"

#include <cmath>

#include "avatar/mind/gaze.h"

namespace wellspring::avatar {
namespace {

constexpr float near_place = 1.3f;   // metres: nearer places are pointed at with a bent arm
constexpr float same_thing = 0.25f;  // metres: no new gesture for the same thing
constexpr float seconds_held = 60;   // longest time that a hand points without a new request
constexpr double answer_again = 8;   // seconds between answers to a visitor's gestures

GestureOrder play(const GestureLibrary& library, std::string_view name) {
  return {.clip = find_gesture(library, name), .lead = -1};
}

// Ends the held moment of the running clip now.
void release(GestureState& gesture, const GestureLibrary& library) {
  if (gesture.clip < 0 || size_t(gesture.clip) >= library.clips.size()) return;
  const GestureClip& clip = library.clips[size_t(gesture.clip)];
  if (clip.hold < 0) return;
  gesture.hold = std::clamp(gesture.time - clip.hold, 0.0f, gesture.hold);
}

// Returns whether a place is to the left, the side to which the gaze goes round, too.
bool is_left(const vec3& here) { return way_round(std::atan2(here.x, here.z)) > 0; }

GestureOrder point_at(const GestureLibrary& library, const vec3& place, const mat4& to_body) {
  vec3 here(to_body * vec4(place, 1));
  GestureOrder order =
      play(library, glm::length(vec2(here.x, here.z)) < near_place ? "point_near" : "point_far");
  order.seconds = seconds_held;
  order.mirrored = is_left(here);  // the nearer hand points
  return order;
}

}  // namespace

GestureOrder choose_gesture(BodyLanguageState& state, GestureState& gesture,
                            const GestureLibrary& library, const StorytellerInput& input,
                            const StorytellerEvents& events, Mood mood, const mat4& to_body,
                            Rng& rng, double now) {
  const StoryCue& story = input.story;
  bool points = story.point && is_finite(*story.point) && mood != Mood::farewell;
  bool elsewhere = points && glm::length(*story.point - state.pointed) > same_thing;
  if (state.pointing && !points) release(gesture, library);
  bool begins = points && (!state.pointing || elsewhere);
  state.pointing = points;
  if (points) state.pointed = *story.point;

  if (mood != Mood::attending) {
    state.attending_since = now;
    state.invitations = 0;
  }
  if (mood != Mood::attending || !input.humanlike) state.next_nod = now + 4;

  // The visitor's leaving overrides everything; the story comes before the situation.
  if (events.farewelled) return play(library, "farewell");
  if (!story.gesture.empty() && mood != Mood::farewell) {
    GestureOrder order = play(library, story.gesture);
    if (order.clip >= 0) {
      order.size = story.gesture_weight;
      order.lead = std::max(story.gesture_lead, 0.0f);
      const GestureClip& clip = library.clips[size_t(order.clip)];
      if (clip.aim != Aim::none && points) {
        vec3 here(to_body * vec4(*story.point, 1));
        order.mirrored = clip.uses_arm[is_left(here) ? 0 : 1] == false;
      }
      return order;
    }
  }
  if (begins) return point_at(library, *story.point, to_body);
  if (events.greeted && !input.telling) return play(library, "greet");
  if (gesture.clip >= 0) return {};
  for (const Guest& guest : input.guests)
    if (guest.kiosk && now - state.answered > answer_again &&
        (guest.gesture == "wave" || guest.gesture == "nod")) {
      state.answered = now;
      return play(library, guest.gesture);
    }
  if (mood != Mood::attending || input.telling) return {};
  double due = patience_seconds + state.invitations * patience_again_seconds;
  if (state.invitations < most_invitations && now - state.attending_since > due) {
    state.invitations++;
    return play(library, "invite");
  }
  if (input.humanlike && now >= state.next_nod) {
    state.next_nod = now + 5 + 6 * double(rng.uniform());
    return play(library, rng.uniform() < 0.3f ? "listen" : "nod");
  }
  return {};
}

}  // namespace wellspring::avatar
