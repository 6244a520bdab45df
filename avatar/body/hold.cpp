// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/hold.h"

#include <algorithm>

namespace wellspring::avatar {
namespace {

const GestureClip* clip_of(const HoldState& state, const GestureLibrary& library) {
  const bool known = state.clip >= 0 && size_t(state.clip) < library.clips.size();
  return known ? &library.clips[size_t(state.clip)] : nullptr;
}

bool same(const HeldThing& a, const HeldThing& b) {
  return a.thing == b.thing && a.gesture == b.gesture && a.side == b.side;
}

}  // namespace

bool can_hold(const GestureClip& clip) {
  const float least = clip.stroke + hold_appears;
  return clip.hold >= least && clip.seconds - clip.hold >= least;
}

void tick_hold(HoldState& state, const GestureLibrary& library, const HeldThing& wanted, float dt) {
  const GestureClip* clip = clip_of(state, library);
  if (!clip) {
    state = {};
    if (wanted.thing < 0) return;
    state.clip = find_gesture(library, wanted.gesture);
    clip = clip_of(state, library);
    if (!clip || !can_hold(*clip)) return (void)(state = {});
    state.held = wanted;
  }
  state.wanted = same(state.held, wanted);
  const float left = clip->seconds - state.time;
  if (state.time > clip->hold) state.time += std::min(dt, left);  // the thing is on its way back
  else if (state.wanted) state.time = std::min(state.time + dt, clip->hold);
  else if (state.time == clip->hold) state.time += std::min(std::max(dt, 1e-4f), left);
  else state.time = std::max(state.time - dt, 0.0f);  // the thing was not up yet: back the same way
  if (state.time >= clip->seconds || (state.time <= 0 && !state.wanted)) state = {};
}

HoldingArm eval_hold(const HoldState& state, const GestureLibrary& library) {
  HoldingArm holding;
  const GestureClip* clip = clip_of(state, library);
  if (!clip) return holding;
  GestureMotion motion = eval_gesture(*clip, state.time);
  const size_t side = size_t(state.held.side);
  if (!clip->uses_arm[side]) swap_sides(motion);
  holding.arm = motion.arm[side];
  holding.weight = motion.weight[side];
  return holding;
}

float eval_held_share(const HoldState& state, const GestureLibrary& library) {
  const GestureClip* clip = clip_of(state, library);
  if (!clip) return 0;
  const float nearer_end = std::min(state.time, clip->seconds - state.time);
  return std::clamp((nearer_end - clip->stroke) / hold_appears, 0.0f, 1.0f);
}

bool is_held_up(const HoldState& state, const GestureLibrary& library) {
  const GestureClip* clip = clip_of(state, library);
  return clip && state.wanted && state.time <= clip->hold && eval_held_share(state, library) >= 1;
}

void keep_to_free_arm(GestureOrder& order, const GestureLibrary& library, const HoldState& state) {
  if (order.clip < 0 || size_t(order.clip) >= library.clips.size() || !clip_of(state, library))
    return;
  const GestureClip& clip = library.clips[size_t(order.clip)];
  if (clip.uses_arm[0] == clip.uses_arm[1]) return;
  order.mirrored = clip.uses_arm[size_t(state.held.side)];
}

std::optional<mat4> eval_grip(const Rig& rig, const Pose& pose, int side) {
  const ArmRig& arm = rig.arm[size_t(side)];
  if (arm.wrist < 0) return std::nullopt;
  const Character& character = *rig.character;
  // These are directions at rest; the hand hangs with its palm inwards when turned by hand_hangs.
  const quat to_rest = glm::conjugate(arm.hand_hangs);
  const vec3 fingers = to_rest * vec3(0, -1, 0), thumb = to_rest * vec3(0, 0, 1);
  const vec3 palm = to_rest * vec3(side == 0 ? -1 : 1, 0, 0);
  const vec3 wrist = character.joints[size_t(arm.wrist)].center;
  vec3 knuckles(0);
  int count = 0;
  for (const FingerJoint& finger : arm.fingers)
    if (finger.finger > 0 && finger.knuckle == 0)
      knuckles += character.joints[size_t(finger.joint)].center, count++;
  constexpr float usual_palm = 0.085f;  // metres from the wrist to the knuckles
  knuckles = count > 0 ? knuckles / float(count) : wrist + usual_palm * fingers;
  // A rod lies in the bend of the fingers, before the palm.
  constexpr float before_palm = 0.30f, behind_knuckles = 0.06f;  // shares of the palm's length
  const float length = glm::length(knuckles - wrist);
  const vec3 place = knuckles + length * (before_palm * palm - behind_knuckles * fingers);

  const JointFrame frame = eval_joint_frame(character, pose, arm.wrist);
  const vec3 y = frame.rotation * thumb, z = frame.rotation * fingers;
  return mat4(vec4(cross(y, z), 0), vec4(y, 0), vec4(z, 0),
              vec4(frame.center + frame.rotation * (place - wrist), 1));
}

}  // namespace wellspring::avatar
