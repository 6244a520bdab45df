// SPDX-License-Identifier: Apache-2.0
#include "avatar/storyteller.h"

#include <algorithm>
#include <cmath>

#include "avatar/body.h"

namespace wellspring {
namespace {

std::shared_ptr<const Rig> rig_of(const StorytellerState& state, const Character& character) {
  const Rig* rig = state.rig.get();
  bool fits = rig && rig->character == &character && rig->joints == character.joints.size() &&
              rig->displacers == character.displacers.size();
  return fits ? state.rig : std::make_shared<const Rig>(make_rig(character));
}

// Guests in humanoid space; those at impossible places are nobody.
std::vector<Guest> guests_here(const std::vector<Guest>& guests, const mat4& placement) {
  std::vector<Guest> here;
  glm::dmat4 to_here = glm::inverse(glm::dmat4(placement));
  for (Guest guest : guests) {
    glm::dvec3 head(to_here * glm::dvec4(guest.head, 1));
    guest.head = vec3(head);
    if (is_finite(guest.head) && glm::length(guest.head) < 1e4f) here.push_back(guest);
  }
  return here;
}

void tick_stance_and_gaze(StorytellerState& state, const Rig& rig, const StorytellerInput& input,
                          const std::vector<Guest>& guests, float dt) {
  double now = state.clock;
  bool motion = now - state.behaviour.last_motion < 2.5;
  if (tick_gaze(state.gaze, rig, state.behaviour, guests, state.stance.heading.value, motion,
                input.humanlike, state.rng, now, dt) &&
      input.humanlike)
    ask_blink(state.blink, now);
  bool kiosk =
      state.behaviour.company || state.mood == Mood::greeting || state.mood == Mood::farewell;
  float reach = kiosk ? 30_deg : state.gaze.at_guest ? 60_deg : -1.0f;
  float patience = state.mood == Mood::greeting ? 0.15f
                   : kiosk                      ? 0.5f
                   : state.gaze.at_guest        ? 1.2f
                                                : 4.0f;
  vec3 way = state.gaze.target - eyes_origin(rig, state.stance.heading.value);
  float aim = state.stance.heading.value;
  if (glm::length(vec2(way.x, way.z)) > 0.05f) {
    aim = std::atan2(way.x, way.z);
    aim += 2 * pi * std::round((state.stance.heading.value - aim) / (2 * pi));
  }
  tick_stance(state.stance, rig.leg[0].complete() && rig.leg[1].complete(), aim, reach, patience,
              now, dt);
}

float wanted_smile(const StorytellerState& state) {
  switch (state.mood) {
    case Mood::greeting: return 0.85f;
    case Mood::farewell: return 0.75f;
    case Mood::attending: return 0.5f;
    case Mood::noticing: return 0.4f;
    case Mood::telling: return 0.3f;
    case Mood::idle: break;
  }
  return state.gaze.at_guest ? 0.38f : 0.2f;
}

// Lids follow the eyes: half closed when they look down, wide when up.
void lids_follow(const Rig& rig, const Pose& pose, float closing, FacePose& face) {
  for (size_t side = 0; side < 2; side++) {
    float pitch = 0;
    if (rig.eyes_move) {
      vec3 ahead = pose.rotations[size_t(rig.eye[side])] * vec3(0, 0, 1);
      pitch = std::asin(std::clamp(ahead.y, -1.0f, 1.0f));
    }
    float droop = pitch < 0 ? std::min(-pitch * 0.9f, 0.5f) : 0;
    face.closed[side] = droop + (1 - droop) * closing;
    face.wide = std::max(face.wide, pitch > 0 ? std::min(pitch * 1.2f, 0.6f) : 0);
  }
}

}  // namespace

void tick_storyteller(StorytellerState& state, const Storyteller& storyteller,
                      const StorytellerInput& input, Pose& pose, StorytellerEvents& events) {
  events = {};
  if (!storyteller.character || storyteller.character->joints.empty()) return;
  const Character& character = *storyteller.character;
  state.rig = rig_of(state, character);
  const Rig& rig = *state.rig;
  float dt = input.dt > 0 && std::isfinite(input.dt) ? std::min(input.dt, 1e6f) : 0;
  state.clock += double(dt);
  double now = state.clock;
  pose.translation = vec3(0);
  pose.rotations.assign(character.joints.size(), quat(1, 0, 0, 0));
  pose.displacers.assign(character.displacers.size(), 0);

  // Notice and decide.
  std::vector<Guest> guests = guests_here(input.guests, storyteller.placement);
  StorytellerInput here = input;
  here.guests = guests;
  decide(state.behaviour, here, now, events);
  state.mood = state.behaviour.mood;

  // Look, turn, gesture.
  tick_stance_and_gaze(state, rig, input, guests, dt);
  const GestureLibrary& library =
      storyteller.gestures ? *storyteller.gestures : default_gestures();
  mat4 to_here = glm::inverse(storyteller.placement);
  GestureOrder order = choose_gesture(state.body_language, state.gesture, library, here, events,
                                      state.mood, to_here, state.rng, now);
  int clip = order.clip >= 0 ? order.clip : state.gesture.clip;
  bool hands_busy = clip >= 0 && (library.clips[size_t(clip)].uses_arm[0] ||
                                  library.clips[size_t(clip)].uses_arm[1]);
  IdleMotion idle =
      tick_idle(state.idle, state.rng, state.face.talking, hands_busy, input.humanlike, now, dt);
  const Guest* mirrored = nullptr;
  for (const Guest& guest : guests)
    if (guest.kiosk && state.gaze.at_guest && guest.id == state.gaze.guest) mirrored = &guest;
  tick_mirror(state.mirror, mirrored != nullptr, mirrored ? mirrored->rotation : vec3(0), now, dt);

  // Body.
  std::array<ArmPose, 2> rest;
  for (size_t i = 0; i < 2; i++) {
    rest[i] = mix(hanging_arm(rig.arm[i].spread), folded_arm(int(i)), state.idle.fold.value);
    rest[i].forward += idle.arm[i].x;
    rest[i].side += idle.arm[i].y;
    rest[i].elbow += idle.arm[i].z;
    rest[i].curl += idle.curl[i];
  }
  GestureMotion gesture = tick_gesture(state.gesture, library, order, rest, dt);
  BodyPlan plan;
  plan.heading = state.stance.heading.value;
  plan.pelvis = idle.pelvis + vec3(state.stance.lean.value, -0.006f, 0);
  plan.pelvis_turn = idle.pelvis_turn;
  plan.pelvis_turn.y += 0.4f * gesture.chest.y;
  plan.torso = idle.torso_turn + vec3(state.gaze.torso_yaw.value, 0, 0) + gesture.chest;
  plan.head = {state.gaze.head_yaw.value + state.mirror.angle.x,
               state.gaze.head_pitch.value + state.mirror.angle.y, 0};
  plan.head += vec3(idle.head_turn.x, -idle.head_turn.y, idle.head_turn.z);
  plan.head += vec3(gesture.head.x, -gesture.head.y - 0.5f * gesture.chest.y, gesture.head.z);
  if (input.humanlike)  // emphasis while speaking
    plan.head.y -= 2.2_deg * state.face.talking *
                   std::sin(float(std::fmod(state.face.syllables * 1.9, 2 * double(pi))));
  plan.gaze_point = gaze_point(state.gaze, rig, plan.heading);
  plan.shoulders_up = 1.0_deg * idle.breath + gesture.shoulders;
  for (size_t i = 0; i < 2; i++) {
    plan.arm[i] = gesture.arm[i];
    plan.foot[i] = {state.stance.foot[i].facing(), state.stance.foot[i].lift()};
  }
  eval_body(rig, plan, pose);

  // Face.
  FacePose face;
  float brow = state.mood == Mood::greeting ? 0.45f : state.mood == Mood::noticing ? 0.3f : 0.05f;
  face.breath = idle.breath;
  tick_face(state.face, input.speaking, input.visemes ? &*input.visemes : nullptr, wanted_smile(state), brow,
            input.humanlike, now, dt, face);
  lids_follow(rig, pose, tick_blink(state.blink, state.rng, now, input.humanlike), face);
  eval_face(rig, face, pose);
}

vec3 eval_mouth(const StorytellerState& state, const Storyteller& storyteller, const Pose& pose) {
  vec3 mouth(0, 1.5f, 0.1f);
  const Rig* rig = state.rig.get();
  if (rig && rig->character == storyteller.character && pose.rotations.size() == rig->joints &&
      rig->skull >= 0) {
    // Below the eyes by a share of the body's height, in the skull's frame.
    const Character& character = *rig->character;
    vec3 at_rest = rig->eyes_center - vec3(0, 0.043f * rig->eyes_center.y, 0);
    JointFrame skull = eval_joint_frame(character, pose, rig->skull);
    mouth = skull.center + skull.rotation * (at_rest - character.joints[size_t(rig->skull)].center);
  }
  return vec3(storyteller.placement * vec4(mouth, 1));
}

StorytellerGaze eval_gaze(const StorytellerState& state, const Storyteller& storyteller,
                          const Pose& pose) {
  StorytellerGaze gaze;
  gaze.target = vec3(storyteller.placement * vec4(state.gaze.target, 1));
  gaze.guest = state.gaze.at_guest ? state.gaze.guest : 0;
  const Rig* rig = state.rig.get();
  if (!rig || rig->character != storyteller.character || pose.rotations.size() != rig->joints)
    return gaze;
  vec3 sight(0);
  if (rig->eyes_move) {
    for (int eye : rig->eye)
      sight += eval_joint_frame(*rig->character, pose, eye).rotation * vec3(0, 0, 1);
  } else {
    int joint = rig->skull >= 0 ? rig->skull : rig->root;
    sight = eval_joint_frame(*rig->character, pose, joint).rotation * vec3(0, 0, 1);
  }
  gaze.yaw = std::atan2(sight.x, sight.z);
  gaze.pitch = std::atan2(sight.y, glm::length(vec2(sight.x, sight.z)));
  return gaze;
}

}  // namespace wellspring
