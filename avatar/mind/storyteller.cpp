// SPDX-License-Identifier: Apache-2.0
#include "avatar/mind/storyteller.h"

#include <algorithm>
#include <cmath>

#include "avatar/body/body.h"
#include "avatar/body/hold.h"
#include "avatar/face/expression_rules.h"
#include "avatar/figure/joint_constraints.h"

namespace wellspring::avatar {
namespace {

std::shared_ptr<const Rig> rig_of(const StorytellerState& state, const Character& character) {
  const Rig* rig = state.rig.get();
  bool fits = rig && rig->character == &character && rig->joints == character.joints.size() &&
              rig->displacers == character.displacers.size();
  return fits ? state.rig : std::make_shared<const Rig>(make_rig(character));
}

// Returns guests in humanoid space, without those at impossible places.
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

std::shared_ptr<const ExpressionRig> expressions_of(const StorytellerState& state,
                                                    const ExpressionSet& set, bool same_rig) {
  bool fits = same_rig && state.expressions && state.expressions->set == &set;
  return fits ? state.expressions
              : std::make_shared<const ExpressionRig>(
                    make_expression_rig(set, *state.rig->character));
}

// Returns the place that the story wants looked at: the one it names, else the one it points at.
std::optional<vec3> place_to_look(const StoryCue& story, const mat4& to_here) {
  const std::optional<vec3>& place = story.look ? story.look : story.point;
  if (!place || !is_finite(*place)) return std::nullopt;
  return vec3(to_here * vec4(*place, 1));
}

void tick_stance_and_gaze(StorytellerState& state, const Rig& rig, const GazeInput& look,
                          float dt) {
  double now = state.clock;
  if (tick_gaze(state.gaze, rig, state.behaviour, look, state.rng, now, dt) && look.humanlike)
    ask_blink(state.blink, now);
  if (state.detail != Detail::none) state.work.eyes++;
  bool kiosk =
      state.behaviour.company || state.mood == Mood::greeting || state.mood == Mood::farewell;
  // The feet stay with a listener, whatever is looked at meanwhile.
  const std::optional<vec3>& listener = state.gaze.listener;
  const bool shows = look.look && !state.gaze.at_guest && !listener;
  float reach = kiosk ? 30_deg : listener ? 60_deg : shows ? 50_deg : -1.0f;
  float patience = state.mood == Mood::greeting ? 0.15f
                   : kiosk || shows             ? 0.5f
                   : listener                   ? 1.2f
                                                : 4.0f;
  vec3 way = listener.value_or(state.gaze.target) - eyes_origin(rig, state.stance.heading.value);
  float heading = state.stance.heading.value, aim = heading;
  if (glm::length(vec2(way.x, way.z)) > 0.05f) {
    aim = heading + way_round(std::atan2(way.x, way.z) - heading);
    // A figure that shows something stands between it and whoever may come.
    if (shows && std::abs(aim - heading) > reach) aim -= std::copysign(30_deg, aim - heading);
  }
  tick_stance(state.stance, rig.leg[0].complete() && rig.leg[1].complete(), aim, reach, patience,
              now, dt);
}

// Glides the hand from one place to the next; a hand that does not point yet begins at the right
// one.
vec3 tick_point(StorytellerState& state, const StorytellerInput& input, const mat4& to_here,
                bool points_now, float dt) {
  vec3 goal(0, 1.2f, 4);
  if (input.story.point && is_finite(*input.story.point))
    goal = vec3(to_here * vec4(*input.story.point, 1));
  else if (points_now) goal = {state.point[0].value, state.point[1].value, state.point[2].value};
  vec3 place(0);
  for (int i = 0; i < 3; i++) {
    Spring& spring = state.point[size_t(i)];
    if (points_now) settle(spring, goal[i], 7, dt);
    else spring = {goal[i], 0};
    place[i] = spring.value;
  }
  return place;
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

// Makes the lids follow the eyes: half closed when they look down, wide when up.
void lids_follow(const Rig& rig, const ExpressionRig& expressions, const Pose& pose, float closing,
                 ExpressionSum& face, Protected& words) {
  for (size_t side = 0; side < 2; side++) {
    float pitch = 0;
    if (rig.eyes_move) {
      vec3 ahead = pose.rotations[size_t(rig.eye[side])] * vec3(0, 0, 1);
      pitch = std::asin(std::clamp(ahead.y, -1.0f, 1.0f));
    }
    float droop = pitch < 0 ? std::min(-pitch * 0.9f, 0.5f) : 0;
    words.closing[side] = droop + (1 - droop) * closing;
    int wide = expressions.flex[size_t(Flex::blink)][side][0];
    if (pitch > 0) add(face, expressions, wide, std::min(pitch * 1.2f, 0.6f));
  }
}

Emotions emotions_of(const StoryCue& story) {
  Emotions emotions;
  if (int emotion = find_emotion(story.emotion); emotion >= 0 && story.emotion_weight > 0)
    emotions.weight[size_t(emotion)] = std::min(story.emotion_weight, 1.0f);
  return emotions;
}

// Returns the arms without any gesture; one of them may hold something.
std::array<ArmPose, 2> arms_at_rest(const Rig& rig, const IdleMotion& idle, float folded,
                                    size_t holding_side, const HoldingArm& holding) {
  std::array<ArmPose, 2> rest;
  for (size_t i = 0; i < 2; i++) {
    rest[i] = mix(hanging_arm(rig.arm[i].spread), folded_arm(int(i)), folded);
    rest[i].forward += idle.arm[i].x;
    rest[i].side += idle.arm[i].y;
    rest[i].elbow += idle.arm[i].z;
    rest[i].curl += idle.curl[i];
  }
  rest[holding_side] = mix(rest[holding_side], holding.arm, holding.weight);
  return rest;
}

}  // namespace

void tick_storyteller(StorytellerState& state, const Storyteller& storyteller,
                      const StorytellerInput& input, Pose& pose, StorytellerEvents& events) {
  events = {};
  if (!storyteller.character || storyteller.character->joints.empty()) return;
  const Character& character = *storyteller.character;
  std::shared_ptr<const Rig> known = rig_of(state, character);
  bool same_rig = known == state.rig;
  state.rig = known;
  const Rig& rig = *state.rig;
  if (!same_rig) state.springs = {};
  state.expressions = expressions_of(
      state, storyteller.expressions ? *storyteller.expressions : default_expressions(), same_rig);
  const ExpressionRig& expressions = *state.expressions;
  float dt = input.dt > 0 && std::isfinite(input.dt) ? std::min(input.dt, 1e6f) : 0;
  state.clock += double(dt);
  double now = state.clock;
  pose.translation = vec3(0);
  pose.rotations.assign(character.joints.size(), quat(1, 0, 0, 0));
  pose.displacers.assign(character.displacers.size(), 0);
  state.work.ticks++;
  state.detail = next_detail(state.detail, input.viewer_distance);
  bool full = state.detail == Detail::full, seen = state.detail != Detail::none;

  // Notice and decide.
  mat4 to_here = glm::inverse(storyteller.placement);
  std::vector<Guest> guests = guests_here(input.guests, storyteller.placement);
  StorytellerInput here = input;
  here.guests = guests;
  decide(state.behaviour, here, now, events);
  state.mood = state.behaviour.mood;

  // Look, turn, gesture.
  GazeInput look{guests,
                 place_to_look(input.story, to_here),
                 state.stance.heading.value,
                 now - state.behaviour.last_motion < 2.5,
                 input.humanlike,
                 full};
  tick_stance_and_gaze(state, rig, look, dt);
  if (full && input.humanlike) state.work.saccades++;
  const GestureLibrary& library = storyteller.gestures ? *storyteller.gestures : default_gestures();
  const mat4 to_body = glm::rotate(mat4(1), -state.stance.heading.value, vec3(0, 1, 0)) * to_here;
  GestureOrder order = choose_gesture(state.body_language, state.gesture, library, here, events,
                                      state.mood, to_body, state.rng, now);
  tick_hold(state.hold, library, input.story.held, dt);
  keep_to_free_arm(order, library, state.hold);
  const HoldingArm holding = eval_hold(state.hold, library);
  const size_t holding_side = size_t(state.hold.held.side);
  int clip = order.clip >= 0 ? order.clip : state.gesture.clip;
  bool hands_busy =
      state.hold.clip >= 0 ||
      (clip >= 0 && size_t(clip) < library.clips.size() &&
       (library.clips[size_t(clip)].uses_arm[0] || library.clips[size_t(clip)].uses_arm[1]));
  bool noise = input.humanlike && seen;
  if (noise) state.work.body_noise++;
  IdleMotion idle =
      tick_idle(state.idle, state.rng, state.face.talking, hands_busy, noise, now, dt);
  const Guest* guest = nullptr;  // kiosk guest who is looked at
  for (const Guest& other : guests)
    if (other.kiosk && state.gaze.at_guest && other.id == state.gaze.guest) guest = &other;
  if (full) {
    tick_mirror(state.mirror, guest != nullptr, guest ? guest->rotation : vec3(0), now, dt);
    state.work.mirror++;
  } else {
    state.mirror = {};
  }
  tick_bow(state.bow, guest ? std::optional(guest->head) : std::nullopt,
           eyes_origin(rig, state.stance.heading.value), dt);
  const float bow = state.bow.share.value;
  std::array<float, 2> free{1, 1};
  free[holding_side] = 1 - holding.weight;
  const std::array<ArmPose, 2> rest =
      arms_at_rest(rig, idle, state.idle.fold.value, holding_side, holding);
  GestureMotion gesture = tick_gesture(state.gesture, library, order, rest, dt, free);
  bool points =
      gesture.finger_aim[0] + gesture.finger_aim[1] + gesture.palm_aim[0] + gesture.palm_aim[1] > 0;
  vec3 point = tick_point(state, input, to_here, points, dt);

  // The face's wishes come first: it nods and tilts the head, too.
  ExpressionSum face;
  Protected words;
  FaceInput asked;
  asked.detail = state.detail;
  asked.speaking = input.speaking;
  asked.visemes = input.visemes ? &*input.visemes : nullptr;
  asked.smile = wanted_smile(state);
  asked.brows = state.mood == Mood::greeting ? 0.45f : state.mood == Mood::noticing ? 0.3f : 0.05f;
  asked.story = emotions_of(input.story);
  asked.parting = state.mood == Mood::farewell;
  asked.beat = input.story.beat;
  asked.visitor = guest && guest->expression ? &*guest->expression : nullptr;
  asked.humanlike = input.humanlike;
  tick_face(state.face, expressions, asked, now, dt, face, words, state.work);

  // Body.
  BodyPlan plan;
  plan.heading = state.stance.heading.value;
  plan.pelvis = idle.pelvis + vec3(state.stance.lean.value, -0.006f - bow_sink * bow, 0);
  plan.pelvis_turn = idle.pelvis_turn;
  plan.pelvis_turn.y += 0.4f * gesture.chest.y;
  plan.torso = idle.torso_turn + vec3(state.gaze.torso_yaw.value, 0, 0) + gesture.chest;
  plan.torso.y += bow_lean * bow;
  plan.head = {state.gaze.head_yaw.value + state.mirror.angle.x,
               state.gaze.head_pitch.value + state.mirror.angle.y, 0};
  plan.head += vec3(idle.head_turn.x, -idle.head_turn.y, idle.head_turn.z);
  plan.head += vec3(gesture.head.x, -gesture.head.y - 0.5f * gesture.chest.y, gesture.head.z);
  plan.head.y -= 3_deg * state.face.beat.value;
  if (noise)  // emphasis while speaking
    plan.head.y -= 2.2_deg * state.face.talking *
                   std::sin(float(std::fmod(state.face.syllables * 1.9, 2 * double(pi))));
  plan.gaze_point = gaze_point(state.gaze, rig, plan.heading);
  plan.shoulders_up = 1.0_deg * idle.breath + gesture.shoulders;
  plan.point = point;
  plan.finger_aim = gesture.finger_aim;
  plan.palm_aim = gesture.palm_aim;
  plan.fingers = seen;
  if (seen) state.work.fingers++;
  for (size_t i = 0; i < 2; i++) {
    plan.arm[i] = gesture.arm[i];
    plan.foot[i] = {state.stance.foot[i].facing(), state.stance.foot[i].lift()};
  }
  eval_body(rig, plan, pose);
  if (!seen) {
    state.springs = {};
    return;
  }

  // Face.
  apply_rotators(face, expressions, pose);
  aim_eyes(rig, plan.gaze_point, pose);
  add(face, expressions, expressions.breathe, idle.breath);
  float lids = tick_blink(state.blink, state.rng, now, input.humanlike);
  state.work.blinks++;
  lids_follow(rig, expressions, pose, lids, face, words);
  protect(face, expressions, words);
  apply_controls(face, expressions, pose);

  // The author's rules, constraints and springs follow, since each depends on all before it.
  follow_expression_rules(character, pose);
  follow_constraints(character, pose);
  if (!character.springs.empty()) {
    tick_spring_bones(state.springs, character, dt, pose);
    state.work.springs++;
  }
}

std::optional<mat4> eval_grip(const StorytellerState& state, const Storyteller& storyteller,
                              const Pose& pose) {
  const Rig* rig = state.rig.get();
  if (state.hold.clip < 0 || !rig || rig->character != storyteller.character ||
      pose.rotations.size() != rig->joints)
    return std::nullopt;
  std::optional<mat4> grip = eval_grip(*rig, pose, state.hold.held.side);
  if (grip) *grip = storyteller.placement * *grip;
  return grip;
}

vec3 eval_mouth(const StorytellerState& state, const Storyteller& storyteller, const Pose& pose) {
  vec3 mouth(0, 1.5f, 0.1f);
  const Rig* rig = state.rig.get();
  if (rig && rig->character == storyteller.character && pose.rotations.size() == rig->joints &&
      rig->skull >= 0) {
    // The mouth is below the eyes by a share of the body's height, in the skull's frame.
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

}  // namespace wellspring::avatar
