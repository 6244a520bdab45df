// SPDX-License-Identifier: Apache-2.0
#include "avatar/face/empathy.h"

#include <cmath>

namespace wellspring::avatar {
namespace {

// [seen][shown]: joy, sadness, anger, fear, disgust, surprise.
constexpr float answers[emotion_count][emotion_count] = {
    {0.9f, 0, 0, 0, 0, 0},      // joy is shared
    {0, 0.6f, 0, 0, 0, 0},      // sadness: concern
    {0, 0.25f, 0, 0, 0, 0},     // anger is met with calm attention
    {0, 0.3f, 0, 0, 0, 0.1f},   // fear: concern
    {0, 0, 0, 0, 0, 0.25f},     // disgust: is something wrong?
    {0.15f, 0, 0, 0, 0, 0.6f},  // surprise is shared, with pleasure
};

}  // namespace

Emotions answer_to(const Emotions& seen) {
  Emotions answer;
  for (size_t s = 0; s < emotion_count; s++) {
    float weight = seen.weight[s];
    if (!(weight > 0)) continue;  // NaN too
    weight = std::min(weight, 1.0f) * smooth_step(0.2f, 0.4f, weight);
    for (size_t a = 0; a < emotion_count; a++) answer.weight[a] += weight * answers[s][a];
  }
  return answer;
}

Emotions tick_empathy(EmpathyState& state, const Emotions* seen, float dt) {
  Emotions wanted = seen ? answer_to(*seen) : Emotions{}, felt;
  for (size_t i = 0; i < emotion_count; i++) {
    settle(state.felt[i], wanted.weight[i], empathy_rate, dt);
    felt.weight[i] = state.felt[i].value;
  }
  return felt;
}

}  // namespace wellspring::avatar
