// SPDX-License-Identifier: Apache-2.0
#include "avatar/gesture.h"

#include "base/vec.h"

namespace wellspring {
namespace {

// A moment of a clip; between moments values move smoothly.
struct Key {
  float time;
  ArmPose left, right;
  float left_weight, right_weight, nod, bow;
};

// The right hand opens towards the guest, the head and chest bow a little.
const ArmPose open_hand{30_deg, 12_deg, 2_deg, 72_deg, -58_deg, -6_deg, 6_deg, 8_deg};
const ArmPose open_hand_wide{36_deg, 16_deg, -16_deg, 58_deg, -66_deg, -12_deg, 4_deg, 5_deg};
// A raised hand, palm to the front.
const ArmPose raised_hand{34_deg, 34_deg, -16_deg, 110_deg, 62_deg, -14_deg, 0, 3_deg};

constexpr float welcome_seconds = 2.9f, wave_seconds = 3.0f, nod_seconds = 0.9f;

const Key welcome[] = {
    {0.0f, {}, open_hand, 0, 0, 0, 0},
    {0.7f, {}, open_hand, 0, 1, 4_deg, 3_deg},
    {1.3f, {}, open_hand_wide, 0, 1, 9_deg, 7_deg},
    {1.9f, {}, open_hand, 0, 1, 1_deg, 2_deg},
    {2.9f, {}, open_hand, 0, 0, 0, 0},
};

const Key farewell[] = {
    {0.0f, {}, raised_hand, 0, 0, 0, 0},
    {0.65f, {}, raised_hand, 0, 1, 2_deg, 1_deg},
    {2.0f, {}, raised_hand, 0, 1, 5_deg, 4_deg},
    {3.0f, {}, raised_hand, 0, 0, 0, 0},
};

template <size_t N>
GestureMotion eval(const Key (&keys)[N], float time) {
  size_t i = 0;
  while (i + 2 < N && time > keys[i + 1].time) i++;
  const Key &a = keys[i], &b = keys[i + 1];
  float t = smooth_step(a.time, b.time, time);
  auto between = [t](float x, float y) { return x + (y - x) * t; };
  GestureMotion motion;
  motion.arm = {mix(a.left, b.left, t), mix(a.right, b.right, t)};
  motion.weight = {between(a.left_weight, b.left_weight), between(a.right_weight, b.right_weight)};
  motion.nod = between(a.nod, b.nod);
  motion.bow = between(a.bow, b.bow);
  return motion;
}

}  // namespace

ArmPose mix(const ArmPose& a, const ArmPose& b, float t) {
  auto m = [t](float x, float y) { return x + (y - x) * t; };
  return {m(a.forward, b.forward), m(a.side, b.side), m(a.turn, b.turn), m(a.elbow, b.elbow),
          m(a.pronate, b.pronate), m(a.flex, b.flex), m(a.tilt, b.tilt), m(a.curl, b.curl)};
}

void start_gesture(GestureState& state, Gesture gesture) {
  state.gesture = gesture;
  state.time = 0;
}

GestureMotion tick_gesture(GestureState& state, float dt) {
  if (state.gesture == Gesture::none) return {};
  state.time += dt;
  float length = state.gesture == Gesture::welcome ? welcome_seconds
                 : state.gesture == Gesture::wave  ? wave_seconds
                                                   : nod_seconds;
  if (!(state.time < length)) {
    state = {Gesture::none, 0, state.next_nod};
    return {};
  }
  float t = state.time;
  if (state.gesture == Gesture::welcome) return eval(welcome, t);
  if (state.gesture == Gesture::wave) {
    GestureMotion motion = eval(farewell, t);
    // Three waves from the elbow and the wrist while the hand is up.
    float swing = std::sin(2 * pi * 1.7f * (t - 0.5f)) * smooth_step(0.5f, 0.8f, t) *
                  (1 - smooth_step(2.1f, 2.6f, t));
    motion.arm[1].turn += 9_deg * swing;
    motion.arm[1].tilt += 12_deg * swing;
    return motion;
  }
  GestureMotion motion;
  float u = t / nod_seconds;
  motion.nod = 5_deg * std::sin(pi * u) * std::sin(pi * u) * (1 + 0.6f * std::sin(4 * pi * u));
  return motion;
}

ArmPose hanging_arm(float spread) {
  float side = std::clamp(spread, 5_deg, 11_deg);
  return {2_deg, side, 6_deg, 17_deg, 14_deg, 4_deg, 0, 20_deg};
}

ArmPose folded_arm(int side) {
  // The left hand lies over the right wrist.
  float over = side == 0 ? 5_deg : 0;
  return {9_deg + over, 9_deg, 38_deg, 72_deg + over, 22_deg, 8_deg, -6_deg, 26_deg};
}

}  // namespace wellspring
