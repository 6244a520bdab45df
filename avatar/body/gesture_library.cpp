// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/gesture_library.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "avatar/face/library.h"

namespace wellspring::avatar {
namespace {

constexpr std::array<std::string_view, 13> arm_fields = {
    "forward", "side",  "turn",  "elbow",  "pronate", "flex",  "tilt",
    "curl",    "thumb", "index", "middle", "ring",    "little"};
constexpr std::array<std::string_view, 6> trunk_fields = {"head.turn",  "head.nod",  "head.tilt",
                                                          "chest.turn", "chest.bow", "chest.lean"};
static_assert(told_channels == 2 * arm_fields.size() + 2 + trunk_fields.size() + 1);

// Rises over `rise` seconds at both ends, so that a swing neither begins nor ends with a jerk.
float envelope(const Swing& swing, float t) {
  float rise = std::min(0.25f, 0.5f * (swing.to - swing.from));
  auto ramp = [&](float x) {
    float u = std::clamp(x / rise, 0.0f, 1.0f);
    return u * u * (3 - 2 * u);
  };
  return ramp(t - swing.from) * ramp(swing.to - t);
}

}  // namespace

int find_gesture_channel(std::string_view name) {
  if (name == "shoulders") return int(told_channels) - 1;
  for (size_t i = 0; i < trunk_fields.size(); i++)
    if (trunk_fields[i] == name) return int(2 * arm_fields.size() + 2 + i);
  for (size_t side = 0; side < 2; side++) {
    std::string_view prefix = side == 0 ? "left." : "right.";
    if (!name.starts_with(prefix)) continue;
    std::string_view field = name.substr(prefix.size());
    if (field == "weight") return int(2 * arm_fields.size() + side);
    for (size_t i = 0; i < arm_fields.size(); i++)
      if (arm_fields[i] == field) return int(side * arm_fields.size() + i);
  }
  return -1;
}

GestureMotion eval_gesture(const GestureClip& clip, float t) {
  if (clip.times.empty()) return {};
  t = t > 0 ? std::min(t, clip.seconds) : 0;
  size_t last = clip.times.size() - 1, i = 0;
  while (i + 1 < last && t > clip.times[i + 1]) i++;
  GestureRow row = clip.rows[0];
  if (last > 0) {
    // Cubic Hermite between two keys.
    float length = clip.times[i + 1] - clip.times[i];
    float u = std::clamp((t - clip.times[i]) / length, 0.0f, 1.0f), v = 1 - u;
    float a = v * v * (1 + 2 * u), b = u * u * (1 + 2 * v);
    float c = u * v * v * length, d = -u * u * v * length;
    for (size_t k = 0; k < gesture_channels; k++)
      row[k] = a * clip.rows[i][k] + b * clip.rows[i + 1][k] + c * clip.slopes[i][k] +
               d * clip.slopes[i + 1][k];
  }
  for (const Swing& swing : clip.swings)
    if (t > swing.from && t < swing.to)
      row[size_t(swing.channel)] +=
          swing.amplitude * envelope(swing, t) *
          std::sin(2 * pi * (swing.hertz * (t - swing.from) + swing.phase));
  return std::bit_cast<GestureMotion>(row);
}

const GestureLibrary& default_gestures() {
  static const GestureLibrary library = read_gestures(default_gestures_json(), "gestures.json");
  return library;
}

int find_gesture(const GestureLibrary& library, std::string_view name) {
  for (size_t i = 0; i < library.clips.size(); i++)
    if (library.clips[i].name == name) return int(i);
  return -1;
}

int find_gesture(std::string_view name) { return find_gesture(default_gestures(), name); }

}  // namespace wellspring::avatar
