// SPDX-License-Identifier: Apache-2.0
// Moves the face in one tick: story, situation and visitor become one sum of expressions, and the
// mouth of a speaking figure (by the timed visemes of its speech, or by made-up syllables if no
// sound is heard) is kept safe in it. docs/expressions.md describes all of it.
#pragma once
#include <array>

#include "avatar/face/expression.h"
#include "avatar/face/expression_sum.h"
#include "avatar/figure/character.h"
#include "avatar/figure/spring_bones.h"
#include "base/rng.h"

namespace wellspring::avatar {

// Keeps the visitor's layer of emotions: what the storyteller feels with the person in front of it.
// It is no copy: joy is shared, sadness and fear are met with concern, anger and disgust are never
// given back. Source: the storyteller and kiosk paper (guest's reactions, weighted); the answers
// and times are ours.

struct EmpathyState {
  std::array<Spring, emotion_count> felt;
};

// The answer is critically damped: 90 % of it are reached after 3.9 / rate = 1.3 s.
inline constexpr float empathy_rate = 3;
// This layer has this weight near the storyteller, and 0 in the other zones (character.h).
inline constexpr float empathy_weight = 0.6f;

// Returns the face that answers `seen` once it has settled. Weak signals (below 0.2) are noise, not
// emotion.
Emotions answer_to(const Emotions& seen);
// Advances the answer by dt. `seen` null: nobody is there, or nothing is known of the face; the
// feeling fades.
Emotions tick_empathy(EmpathyState& state, const Emotions* seen, float dt);

struct FaceState {
  PerlinFace perlin;                          // the situation's layer
  std::array<Spring, emotion_count> emotion;  // weights as shown
  EmpathyState empathy;                       // the visitor's layer
  Spring beat;                                // emphasis by brows and head
  float beat_wanted = 0;
  float talking = 0;     // 0..1, follows FaceInput::speaking
  double syllables = 0;  // number spoken so far
};

struct FaceInput {
  Detail detail = Detail::full;
  float speaking = 0;                              // 0..1
  const std::array<float, 15>* visemes = nullptr;  // null: made-up syllables
  float smile = 0, brows = 0;                      // wishes of the situation, 0..1
  Emotions story;                                  // wish of the story
  bool parting = false;                            // a farewell overrides the story's face
  float beat = 0;                                  // an emphasised word begins
  const Emotions* visitor = nullptr;               // the guest's face, if known
  bool humanlike = true;
};

// Returns the emotions that all layers together ask for: story + weight * visitor, bounded.
Emotions layered(const Emotions& story, const Emotions& visitor, float weight,
                 float override_amount);

// Overwrites `sum` and `words` (all but words.closing). Counts its work in `work`.
void tick_face(FaceState& state, const ExpressionRig& rig, const FaceInput& input, double now,
               float dt, ExpressionSum& sum, Protected& words, StorytellerWork& work);

// Makes the eyes blink: every 2 to 5 seconds, sometimes twice, 70 ms down and 120 ms up. State is a
// value.

struct BlinkState {
  double next = 1.5;     // time at which the coming blink starts, s
  double begun = -1e30;  // time at which the last one started, s
  bool twice = false;    // the coming blink is the second of a pair
  long count = 0;
};

// Returns how far the lids are closed, 0..1. `humanlike` false: one blink every 4 seconds.
float tick_blink(BlinkState& state, Rng& rng, double now, bool humanlike);
// Starts a blink now unless one is under way or has just been: the eyes blink with a large turn of
// the gaze.
void ask_blink(BlinkState& state, double now);

}  // namespace wellspring::avatar
