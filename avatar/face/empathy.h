// SPDX-License-Identifier: Apache-2.0
// The visitor's layer of emotions: what the storyteller feels with the person in front of it. Not a
// copy: joy is shared, sadness and fear are met with concern, anger and disgust are never given
// back. Source: the storyteller and kiosk paper (guest's reactions, weighted); the answers and
// times are ours.
#pragma once
#include <array>

#include "avatar/face/emotion.h"
#include "avatar/figure/spring.h"

namespace wellspring::avatar {

struct EmpathyState {
  std::array<Spring, emotion_count> felt;
};

// Critically damped: 90 % of an answer after 3.9 / rate = 1.3 s.
inline constexpr float empathy_rate = 3;
// Weight of this layer near the storyteller; 0 in the other zones (lod.h).
inline constexpr float empathy_weight = 0.6f;

// The face that answers `seen` once it has settled. Weak signals (below 0.2) are prior variance,
// not emotion.
Emotions answer_to(const Emotions& seen);
// `seen` null: nobody, or nothing known of the face; the feeling fades.
Emotions tick_empathy(EmpathyState& state, const Emotions* seen, float dt);

}  // namespace wellspring::avatar
