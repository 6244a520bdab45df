// SPDX-License-Identifier: Apache-2.0
// Describes the input and the output of the storyteller's tick.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "avatar/face/expression.h"
#include "avatar/figure/spring_bones.h"
#include "avatar/story/timeline.h"
#include "base/vec.h"

namespace wellspring::avatar {

// This is somebody the storyteller can be aware of. Coordinates are the world's (as `placement`).
struct Guest {
  uint64_t id = 0;
  vec3 head{0};        // place between the eyes
  vec3 rotation{0};    // yaw, pitch, roll of the head relative to facing the storyteller squarely;
                       // yaw positive to the guest's right, pitch positive up
  bool kiosk = false;  // a person in front of a kiosk (is greeted); else a remote visitor's camera
                       // (is looked at)
  std::optional<Emotions> expression{};  // expression as far as the kiosk sees it
  std::string gesture{};                 // gesture of the guest; "wave" and "nod" are answered
};

// Names what the storyteller is doing, for the page and for tests.
enum class Mood : uint8_t { idle, noticing, greeting, attending, telling, farewell };
const char* to_string(Mood mood);

struct StorytellerInput {
  double time = 0;            // seconds, the show's clock
  float dt = 0;               // seconds since the last tick; any size from 0 to hours is safe
  bool kiosk_motion = false;  // something moves before a kiosk but nobody is recognised yet
  std::vector<Guest> guests;
  bool staying = false;  // a kiosk's guest is thought to be there still, seen or not: no farewell
  bool met = false;      // the kiosk's guests were greeted before, and are not again
  bool parting = false;  // the guests have just left: farewell
  uint64_t visit = 0;  // number of these guests' visit: people known from another one are forgotten
  bool humanlike = true;  // noise for human-like behaviour; off: bit-identical replays
  float speaking = 0;     // mouth activity 0..1: it says something right now
  // Mouth shapes of the speech that is heard (order of Rig::viseme); without them the mouth moves
  // as if it spoke.
  std::optional<std::array<float, 15>> visemes;
  bool telling =
      false;  // a story is being told (Mood::telling while no greeting or farewell is due)
  float viewer_distance =
      0;  // metres to the nearest viewer: how much of the storyteller needs to run (character.h)
  StoryCue story;  // wishes of the story's text to face, eyes and hands
};

// Holds what happened in this tick, for subtitles and messages.
struct StorytellerEvents {
  bool greeted = false, farewelled = false;
  uint64_t guest = 0;  // the guest concerned
};

// Bends the storyteller to a guest whose eyes are lower than its own, a child or somebody in a
// wheelchair: knees and chest together, softly, and only to guests who stand near.

struct BowState {
  Spring share;  // 0: upright, 1: as far as it bends
};

// Metres: from the first on the storyteller bends to lower eyes, from the second on wholly; less is
// met by looking down alone.
inline constexpr float bow_from = 0.15f, bow_all = 0.4f;
// Metres to the guest's eyes: the storyteller bends wholly within the first, not at all beyond the
// second; to somebody far off it would be a bow.
inline constexpr float bow_near = 2, bow_far = 3.5f;
// A whole bow sinks the pelvis by so many metres and leans the chest by so many radians.
inline constexpr float bow_sink = 0.1f, bow_lean = 14.0_deg;

// Advances the bow. `guest` holds the eyes of the guest looked at, null for nobody; `eyes` the
// storyteller's own when it stands upright, in the same space.
void tick_bow(BowState& state, std::optional<vec3> guest, vec3 eyes, float dt);

// Mirrors the guest's head lazily: its rotation, halved, late and soft, is to be added to the
// storyteller's own. Source: storyteller and kiosk paper, "a delayed and lazy mirror"; its numbers
// are ours.

inline constexpr float mirror_share = 0.5f, mirror_delay = 0.35f, mirror_lag = 0.6f;

struct MirrorState {
  struct Heard {
    double time = -1e30;
    vec2 wanted{0};
  };
  std::array<Heard, 64> heard;  // ring of changes still on their way, oldest first from `first`
  int first = 0, count = 0;
  vec2 arrived{0};  // delayed angle that the lag follows
  vec2 angle{0};    // yaw to the storyteller's own left (the guest's right), pitch up; radians
};

// Advances the mirror by `dt`, after which the clock is `now`. `rotation` is Guest::rotation; if
// not `present`, the wanted angle is 0.
void tick_mirror(MirrorState& state, bool present, vec3 rotation, double now, float dt);

}  // namespace wellspring::avatar
