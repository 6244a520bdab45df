// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/gesture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "avatar/face/library_json.h"

namespace wellspring::avatar {
namespace {

// 1/s; nine tenths of a broken-off motion's rest are gone in 0.43 s
constexpr float settle_rate = 9;
constexpr float head_start = 0.15f;  // seconds of a clip that are played before its stroke at least

GestureRow row_of(const GestureMotion& motion) { return std::bit_cast<GestureRow>(motion); }
GestureMotion motion_of(const GestureRow& row) { return std::bit_cast<GestureMotion>(row); }

// Returns the time inside the clip; the held moment lasts `hold` seconds longer.
float clip_time(const GestureClip& clip, float time, float hold) {
  if (clip.hold < 0 || time <= clip.hold) return time;
  return time <= clip.hold + hold ? clip.hold : time - hold;
}

// Evaluates the running clip alone, with arms as they are to be.
GestureMotion eval_clip(const GestureState& state, const GestureLibrary& library,
                        const std::array<ArmPose, 2>& rest, float time) {
  GestureMotion motion;
  if (state.clip >= 0 && size_t(state.clip) < library.clips.size()) {
    const GestureClip& clip = library.clips[size_t(state.clip)];
    motion = eval_gesture(clip, clip_time(clip, time, state.hold));
    if (state.mirrored) swap_sides(motion);
    for (size_t s = 0; s < 2; s++) motion.weight[s] *= state.free[s];
    if (clip.aim == Aim::finger) motion.finger_aim = motion.weight;
    if (clip.aim == Aim::palm) motion.palm_aim = motion.weight;
    motion.head *= state.size;
    motion.chest *= state.size;
    motion.shoulders *= state.size;
  }
  for (size_t s = 0; s < 2; s++) {
    // A smaller gesture stays nearer to the resting arm.
    ArmPose arm = mix(rest[s], motion.arm[s], 0.35f + 0.65f * state.size);
    motion.arm[s] = limit_arm(mix(rest[s], arm, motion.weight[s]));
  }
  return motion;
}

// Starts a new clip; the difference to the pose shown, in place and speed, is left to springs.
void begin(GestureState& state, const GestureLibrary& library, const GestureOrder& order,
           const std::array<ArmPose, 2>& rest) {
  constexpr float h = 1e-3f;
  GestureRow was = row_of(eval_clip(state, library, rest, state.time));
  GestureRow before = row_of(eval_clip(state, library, rest, state.time - h));
  const GestureClip& clip = library.clips[size_t(order.clip)];
  state.clip = order.clip;
  state.size = order.size >= 0 ? std::min(order.size, 1.0f) : 1;
  state.mirrored = order.mirrored;
  state.hold = clip.hold >= 0 && order.seconds > clip.seconds
                   ? std::min(order.seconds, longest_gesture) - clip.seconds
                   : 0;
  float lead = order.lead >= 0 ? std::min(order.lead, longest_gesture) : clip.stroke;
  state.time = std::min(clip.stroke - lead, std::max(clip.stroke - head_start, 0.0f));
  GestureRow now = row_of(eval_clip(state, library, rest, state.time));
  GestureRow after = row_of(eval_clip(state, library, rest, state.time + h));
  for (size_t i = 0; i < gesture_channels; i++) {
    Spring& spring = state.left_over[i];
    spring.value += was[i] - now[i];
    spring.velocity += ((was[i] - before[i]) - (after[i] - now[i])) / h;
  }
  state.blending = true;
}

}  // namespace

void swap_sides(GestureMotion& motion) {
  std::swap(motion.arm[0], motion.arm[1]);
  std::swap(motion.weight[0], motion.weight[1]);
  std::swap(motion.finger_aim[0], motion.finger_aim[1]);
  std::swap(motion.palm_aim[0], motion.palm_aim[1]);
  motion.head.x = -motion.head.x, motion.head.z = -motion.head.z;
  motion.chest.x = -motion.chest.x, motion.chest.z = -motion.chest.z;
}

ArmPose mix(const ArmPose& a, const ArmPose& b, float t) {
  constexpr size_t n = sizeof(ArmPose) / sizeof(float);
  using Row = std::array<float, n>;
  Row x = std::bit_cast<Row>(a), y = std::bit_cast<Row>(b);
  for (size_t i = 0; i < n; i++) x[i] += (y[i] - x[i]) * t;
  return std::bit_cast<ArmPose>(x);
}

ArmPose limit_arm(const ArmPose& arm) {
  auto within = [](float v, float low, float high) { return std::clamp(v, low, high); };
  ArmPose limited = arm;
  limited.forward = within(arm.forward, -50_deg, 175_deg);
  limited.side = within(arm.side, -45_deg, 150_deg);
  limited.turn = within(arm.turn, -80_deg, 80_deg);
  limited.elbow = within(arm.elbow, 0, 145_deg);
  limited.pronate = within(arm.pronate, -90_deg, 90_deg);
  limited.flex = within(arm.flex, -70_deg, 80_deg);
  limited.tilt = within(arm.tilt, -30_deg, 22_deg);
  limited.curl = within(arm.curl, -15_deg, 80_deg);
  for (float& finger : limited.finger) finger = within(finger, -70_deg, 80_deg);
  return limited;
}

GestureMotion tick_gesture(GestureState& state, const GestureLibrary& library,
                           const GestureOrder& order, const std::array<ArmPose, 2>& rest, float dt,
                           const std::array<float, 2>& free) {
  state.free = free;
  if (order.clip >= 0 && size_t(order.clip) < library.clips.size())
    begin(state, library, order, rest);
  if (state.clip >= 0) state.time += dt;
  bool known = state.clip >= 0 && size_t(state.clip) < library.clips.size();
  if (known && !(state.time < library.clips[size_t(state.clip)].seconds + state.hold))
    state.clip = -1;
  GestureMotion motion = eval_clip(state, library, rest, state.time);
  if (!state.blending) return motion;
  GestureRow row = row_of(motion);
  state.blending = false;
  for (size_t i = 0; i < gesture_channels; i++) {
    Spring& spring = state.left_over[i];
    settle(spring, 0, settle_rate, dt);
    if (std::abs(spring.value) < 1e-5f && std::abs(spring.velocity) < 1e-4f) spring = {};
    else state.blending = true;
    row[i] += spring.value;
  }
  motion = motion_of(row);
  for (size_t s = 0; s < 2; s++) {
    motion.arm[s] = limit_arm(motion.arm[s]);
    for (float* part : {&motion.weight[s], &motion.finger_aim[s], &motion.palm_aim[s]})
      *part = std::clamp(*part, 0.0f, 1.0f);
  }
  return motion;
}

ArmPose hanging_arm(float spread) {
  float side = std::clamp(spread, 5_deg, 11_deg);
  return {2_deg, side, 6_deg, 17_deg, 14_deg, 4_deg, 0, 20_deg, {}};
}

ArmPose folded_arm(int side) {
  // The left hand lies over the right wrist.
  float over = side == 0 ? 5_deg : 0;
  return {9_deg + over, 9_deg, 38_deg, 72_deg + over, 22_deg, 8_deg, -6_deg, 26_deg, {}};
}

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
    // Interpolates by a cubic Hermite curve between two keys.
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
