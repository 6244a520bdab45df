// SPDX-License-Identifier: Apache-2.0
// What goes into a tick of the storyteller and what comes out of it.
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

// Somebody the storyteller can be aware of. Coordinates are the world's (as `placement`).
struct Guest {
  uint64_t id = 0;
  vec3 head{0};        // between the eyes
  vec3 rotation{0};    // yaw, pitch, roll of the head relative to facing the storyteller squarely;
                       // yaw positive to the guest's right, pitch positive up
  bool kiosk = false;  // a person in front of a kiosk (is greeted); else a remote visitor's camera
                       // (is looked at)
  std::optional<Emotions> expression{};  // as far as the kiosk sees it
  std::string gesture{};                 // the guest's own; "wave" and "nod" are answered
};

// What the storyteller is doing, for the page and for tests.
enum class Mood : uint8_t { idle, noticing, greeting, attending, telling, farewell };
const char* to_string(Mood mood);

struct StorytellerInput {
  double time = 0;            // seconds, the show's clock
  float dt = 0;               // since the last tick; any size from 0 to hours is safe
  bool kiosk_motion = false;  // something moves before a kiosk but nobody is recognised yet
  std::vector<Guest> guests;
  bool staying = false;   // a kiosk's guest is taken to be there still, seen or not: no farewell
  bool met = false;       // the kiosk's guests were greeted before, and are not again
  bool parting = false;   // they have just left: farewell
  uint64_t visit = 0;     // of these guests: who was known from another is forgotten
  bool humanlike = true;  // noise for human-like behaviour; off: bit-identical replays
  float speaking = 0;     // mouth activity 0..1: it says something right now
  // Mouth shapes of the speech that is heard (order of Rig::viseme); without them the mouth moves
  // as if it spoke.
  std::optional<std::array<float, 15>> visemes;
  bool telling =
      false;  // a story is being told (Mood::telling while no greeting or farewell is due)
  float viewer_distance =
      0;           // metres to the nearest who sees it: how much of it needs to run (character.h)
  StoryCue story;  // what its text asks of face, eyes and hands
};

// What happened in this tick, for subtitles and messages.
struct StorytellerEvents {
  bool greeted = false, farewelled = false;
  uint64_t guest = 0;  // whom it concerns
};

// How the storyteller bends to a guest whose eyes are lower than its own, a child or somebody in a
// wheelchair: knees and chest together, softly, and only to who stands near.

struct BowState {
  Spring share;  // 0: upright, 1: as far as it bends
};

// Metres: eyes that are so much lower are met by looking down alone, and from the second on by all.
inline constexpr float bow_from = 0.15f, bow_all = 0.4f;
// Metres to the guest's eyes, within which it bends wholly, and beyond which not at all: to bend to
// somebody far off is a bow.
inline constexpr float bow_near = 2, bow_far = 3.5f;
// Of a whole one: metres that the pelvis sinks, radians that the chest leans.
inline constexpr float bow_sink = 0.1f, bow_lean = 14.0_deg;

// `guest`: the eyes of who is looked at, `eyes`: its own when it stands upright, in one space;
// null: nobody.
void tick_bow(BowState& state, std::optional<vec3> guest, vec3 eyes, float dt);

// The lazy mirror: the guest's head rotation, halved, late and soft, to be added to the
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
  vec2 arrived{0};  // what the lag follows
  vec2 angle{0};    // yaw to its own left (the guest's right), pitch up; radians
};

// `rotation` as Guest::rotation; `present` false: the wanted angle is 0. `now` is the clock after
// `dt`.
void tick_mirror(MirrorState& state, bool present, vec3 rotation, double now, float dt);

}  // namespace wellspring::avatar
