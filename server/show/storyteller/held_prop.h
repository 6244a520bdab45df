// SPDX-License-Identifier: Apache-2.0
// What a teller holds, as it is seen and as it lights: it grows in the hand that fetches it, is lit
// when it is taken, and goes out before it is gone. Light never changes at once, whatever breaks
// the story off: it takes glow_seconds from nothing to full.
#pragma once
#include "avatar/mind/storyteller.h"
#include "avatar/story/timeline.h"
#include "light/virtual/direct_light.h"
#include "show/exhibit/exhibit.h"
#include "show/moving/prop.h"
#include "show/storyteller/voice.h"

namespace wellspring::show {

struct HeldProp {
  int prop = -1;     // index into Exhibit::props; -1: nothing is held and nothing shines
  float size = 0;    // 0..1: how much of it is seen
  float glow = 0;    // 0..1: how far it is lit
  mat4 to_world{1};  // from the fist to the world, relative to Scene::origin, when last held
};

inline constexpr float glow_seconds = 0.6f;

// Finds the thing that the story has her hold, by the name that its mark gives.
HeldThing find_held_thing(const Exhibit& exhibit, const std::string& prop);

// After tick_storyteller(); `visible`: she is there to be seen.
void advance_held(const Exhibit& exhibit, const Storyteller& storyteller,
                  const StorytellerState& state, const Pose& pose, bool visible, float dt,
                  HeldProp& held);

// How prop number `prop` is seen at that time.
PropPose pose_of(const Exhibit& exhibit, const HeldProp& held, int prop, double time);

// Adds the lights of what is held, as they are at that time; their ids begin with `first_id`.
void add_held_lights(const Exhibit& exhibit, const HeldProp& held, double time, uint32_t first_id,
                     DynamicLights& lights);

// A story's marks on the stage of an exhibit: names become places in the world, for the
// storyteller's body.

// Returns what the story asks of the body now; nothing while nothing marked is told. `events` are
// this tick's.
StoryCue make_cue(const Exhibit& exhibit, const Voice& voice, const VoiceEvents& events);

}  // namespace wellspring::show
