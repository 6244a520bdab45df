// SPDX-License-Identifier: Apache-2.0
// The face as numbers 0..1, and the mouth of somebody who speaks: by the timed visemes of its speech, or
// by made-up syllables where nothing is heard.
#pragma once
#include <array>

#include "avatar/pose.h"
#include "avatar/rig.h"
#include "avatar/spring.h"

namespace wellspring {

struct FaceState {
  Spring smile, brow;
  float talking = 0;     // 0..1, follows StorytellerInput::speaking
  double syllables = 0;  // spoken so far
};

struct FacePose {
  std::array<float, 2> closed{0, 0};  // lids, left and right
  std::array<float, 2> smile{0, 0}, brow_up{0, 0};
  float brow_inner_up = 0, squint = 0, wide = 0, breath = 0;
  float open = 0;                  // jaw
  std::array<float, 15> viseme{};  // as Rig::viseme
};

// Mouth, smile and brows. `smile` is the wanted level 0..1. `visemes` (null: made-up syllables) are taken
// as they are, so that lips meet when the sound says so.
void tick_face(FaceState& state, float speaking, const std::array<float, 15>* visemes, float smile,
               float brow, bool humanlike, double now, float dt, FacePose& face);
// Writes the face into displacers, and into lid and jaw joints where the figure has vertices on
// them.
void eval_face(const Rig& rig, const FacePose& face, Pose& pose);

}  // namespace wellspring
