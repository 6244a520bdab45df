// SPDX-License-Identifier: Apache-2.0
// What a story asks of the storyteller's body at this moment: the first layer of its emotions and
// motions, the same every time the story is told. Places are the world's.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "avatar/body/hold.h"
#include "base/vec.h"

namespace wellspring::avatar {

struct StoryCue {
  // Held until the story says otherwise.
  std::string emotion;       // joy sadness anger fear disgust surprise; empty: none
  float emotion_weight = 0;  // 0..1
  std::optional<vec3> look;  // instead of the guest
  std::optional<vec3>
      point;  // held out at by the hand that is nearer; look too, unless told otherwise
  HeldThing held;
  // Begins in this tick.
  std::string gesture;       // name of the library; empty: none begins
  float gesture_weight = 1;  // 0..1, how large
  float gesture_lead = 0;    // seconds until the word that its stroke belongs to
  float beat = 0;            // 0..1: an emphasised word begins (brows and head)
  uint32_t seed = 0;         // of the story: what is random in telling it starts from here
};

}  // namespace wellspring::avatar
