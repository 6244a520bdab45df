// SPDX-License-Identifier: Apache-2.0
// The six archetypal expressions of MPEG-4 (ISO/IEC 14496-2, table of expression_select), by name
// and as a vector of weights. What a story, a situation and a visitor each ask for is such a
// vector.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace wellspring::avatar {

enum class Emotion : uint8_t { joy, sadness, anger, fear, disgust, surprise };
inline constexpr size_t emotion_count = 6;
inline constexpr std::array<std::string_view, emotion_count> emotion_names = {
    "joy", "sadness", "anger", "fear", "disgust", "surprise"};

// Weights, 0..1 each where a face is to show them. All zero: neutral.
struct Emotions {
  std::array<float, emotion_count> weight{};
  float& operator[](Emotion emotion) { return weight[size_t(emotion)]; }
  float operator[](Emotion emotion) const { return weight[size_t(emotion)]; }
  bool operator==(const Emotions&) const = default;
};

// Index into emotion_names; -1: no such emotion.
constexpr int find_emotion(std::string_view name) {
  for (size_t i = 0; i < emotion_count; i++)
    if (emotion_names[i] == name) return int(i);
  return -1;
}

}  // namespace wellspring::avatar
