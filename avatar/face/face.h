// SPDX-License-Identifier: Apache-2.0
// The face in one tick: story, situation and visitor become one sum of expressions, and the mouth
// of somebody who speaks (by the timed visemes of its speech, or by made-up syllables where nothing
// is heard) is kept safe in it. docs/expressions.md tells the whole of it.
#pragma once
#include <array>

#include "avatar/face/empathy.h"
#include "avatar/face/expression_sum.h"
#include "avatar/figure/lod.h"
#include "avatar/face/perlin_face.h"
#include "avatar/figure/spring.h"

namespace wellspring::avatar {

struct FaceState {
  PerlinFace perlin;                          // the situation's layer
  std::array<Spring, emotion_count> emotion;  // as shown
  EmpathyState empathy;                       // the visitor's layer
  Spring beat;                                // emphasis: brows and head
  float beat_wanted = 0;
  float talking = 0;     // 0..1, follows FaceInput::speaking
  double syllables = 0;  // spoken so far
};

struct FaceInput {
  Detail detail = Detail::full;
  float speaking = 0;                              // 0..1
  const std::array<float, 15>* visemes = nullptr;  // null: made-up syllables
  float smile = 0, brows = 0;                      // what the situation asks for, 0..1
  Emotions story;                                  // what the story asks for
  bool parting = false;                            // a farewell overrides the story's face
  float beat = 0;                                  // an emphasised word begins
  const Emotions* visitor = nullptr;               // the guest's face, if known
  bool humanlike = true;
};

// The emotions that all layers together ask for: story + weight * visitor, bounded.
Emotions layered(const Emotions& story, const Emotions& visitor, float weight,
                 float override_amount);

// Overwrites `sum` and `words` (all but words.closing). Counts what it does.
void tick_face(FaceState& state, const ExpressionRig& rig, const FaceInput& input, double now,
               float dt, ExpressionSum& sum, Protected& words, StorytellerWork& work);

}  // namespace wellspring::avatar
