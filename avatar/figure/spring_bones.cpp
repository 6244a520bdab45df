// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/spring_bones.h"

#include <algorithm>
#include <cmath>

namespace wellspring::avatar {
namespace {

using Frame = SpringBonesState::Frame;

constexpr float rule_rate = 60;  // Hz, rate of the steps that the format's numbers are meant for
constexpr float fastest_turn = 200;  // radians a second

vec3 direction_or(vec3 v, vec3 otherwise) {
  float length = glm::length(v);
  return length > 1e-9f && std::isfinite(length) ? v / length : otherwise;
}

vec3 any_across(vec3 v) {
  return glm::normalize(cross(v, std::abs(v.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0)));
}

// Returns the shortest turn from one direction to another, as axis times angle.
vec3 turn_vector(vec3 from, vec3 to) {
  vec3 axis = cross(from, to);
  float sine = glm::length(axis), cosine = dot(from, to);
  if (sine < 1e-7f) return cosine > 0 ? vec3(0) : any_across(from) * pi;
  return axis * (std::atan2(sine, cosine) / sine);
}

quat rotation_of(vec3 turn) {
  float angle = glm::length(turn);
  return angle > 1e-9f ? glm::angleAxis(angle, turn / angle) : quat(1, 0, 0, 0);
}

// Solves x'' = -square x - drag x' over dt, exactly.
void swing(vec3& x, vec3& v, float square, float drag, float dt) {
  float a = 0.5f * drag, apart = a * a - square, c, s;  // x' = c x + s (v + a x), damped already
  if (apart < -1e-4f) {
    float w = std::sqrt(-apart), e = std::exp(-a * dt);
    c = e * std::cos(w * dt), s = e * std::sin(w * dt) / w;
  } else if (apart > 1e-4f) {
    float w = std::sqrt(apart);
    float slow = std::exp(-square / (a + w) * dt), fast = std::exp(-(a + w) * dt);
    c = 0.5f * (slow + fast), s = 0.5f * (slow - fast) / w;
  } else {
    c = std::exp(-a * dt), s = c * dt;
  }
  vec3 pushed = v + a * x;
  vec3 next = c * x + s * pushed;
  v = c * v - s * (square * x + a * v);
  x = next;
}

Frame frame_of(const Character& character, const Pose& pose, size_t j,
               const std::vector<Frame>& frames) {
  const Joint& joint = character.joints[j];
  Frame frame;
  if (joint.parent < 0) {
    frame.center = joint.center + pose.translation;
    frame.rotation = pose.rotations[j];
    return frame;
  }
  const Frame& parent = frames[size_t(joint.parent)];
  frame.center = parent.center +
                 parent.rotation * (joint.center - character.joints[size_t(joint.parent)].center);
  frame.rotation = parent.rotation * pose.rotations[j];
  return frame;
}

// This is a bone's end at `pivot + length * way`, which must turn to keep clear of colliders: for
// each form of collider, `way` must keep its share along some axis on one side of a border.
struct Reach {
  vec3 pivot;
  float length, radius;
};

vec3 keep_side(vec3 way, vec3 axis, float border, bool above) {
  float share = dot(way, axis);
  if (above ? share >= border : share <= border) return way;
  float h = std::clamp(border, -1.0f, 1.0f);
  vec3 across = direction_or(way - axis * share, any_across(axis));
  return direction_or(axis * h + across * std::sqrt(1 - h * h), way);
}

vec3 keep_clear(const SpringCollider& collider, const Character& character,
                const std::vector<Frame>& frames, const Reach& reach, vec3 way) {
  const Frame& frame = frames[size_t(collider.joint)];
  vec3 center = character.joints[size_t(collider.joint)].center;
  vec3 a = frame.center + frame.rotation * (collider.place - center);
  if (collider.normal != vec3(0)) {
    vec3 normal = frame.rotation * collider.normal;
    return keep_side(way, normal, (reach.radius - dot(reach.pivot - a, normal)) / reach.length,
                     true);
  }
  vec3 along = frame.rotation * (collider.tail - collider.place);
  float square = dot(along, along);
  float apart = collider.inside ? std::max(collider.radius - reach.radius, 0.0f)
                                : collider.radius + reach.radius;
  for (int round = 0; round < (square > 0 ? 4 : 1);
       round++) {  // the nearest ball of a capsule moves
    vec3 ball = a, end = reach.pivot + reach.length * way;
    if (square > 0) ball += along * std::clamp(dot(end - a, along) / square, 0.0f, 1.0f);
    vec3 axis = ball - reach.pivot;
    float distance = glm::length(axis);
    if (!(distance > 1e-6f)) break;  // the same wherever the bone turns
    // The law of cosines compares |length way - distance axis| with `apart`.
    float border = (reach.length * reach.length + distance * distance - apart * apart) /
                   (2 * reach.length * distance);
    vec3 next = keep_side(way, axis / distance, border, collider.inside);
    if (next == way) break;
    way = next;
  }
  return way;
}

}  // namespace

void tick_spring_bones(SpringBonesState& state, const Character& character, float dt, Pose& pose) {
  if (character.springs.empty() || pose.rotations.size() != character.joints.size()) return;
  bool begun = state.bones.size() == character.springs.size();
  if (!begun) state.bones.assign(character.springs.size(), {});
  if (!(dt >= 0)) dt = 0;
  std::vector<Frame>& frames = state.frames;
  frames.resize(character.joints.size());
  for (size_t j = 0; j < frames.size(); j++) frames[j] = frame_of(character, pose, j, frames);

  size_t k = 0;
  for (size_t j = size_t(character.springs[0].joint); j < frames.size(); j++) {
    int parent = character.joints[j].parent;
    bool swings = k < character.springs.size() && size_t(character.springs[k].joint) == j;
    if (!swings) {
      if (parent < 0 || !frames[size_t(parent)].changed) continue;
      frames[j] = frame_of(character, pose, j, frames);
      frames[j].changed = true;
      continue;
    }
    const SpringBone& bone = character.springs[k];
    SpringBoneState& own = state.bones[k++];
    Frame& frame = frames[j] = frame_of(character, pose, j, frames);
    frame.changed = true;
    Frame base;
    if (bone.center >= 0) base = frames[size_t(bone.center)];
    vec3 modelled = direction_or(frame.rotation * bone.tail, vec3(0, -1, 0));
    float length = glm::length(bone.tail);
    vec3 force = modelled * bone.stiffness + bone.gravity;
    float strength = glm::length(force);
    vec3 wanted = direction_or(force, modelled);
    vec3 way = wanted, turning(0);
    if (begun) {
      way = direction_or(base.center + base.rotation * own.end - frame.center, wanted);
      turning = base.rotation * own.turning;
      vec3 off = turn_vector(wanted, way);
      turning -= wanted * dot(wanted, turning);
      float drag = -rule_rate * std::log(std::max(1 - bone.drag, 1e-6f));
      swing(off, turning, rule_rate * strength / length, drag, dt);
      float speed = glm::length(turning);
      if (speed > fastest_turn) turning *= fastest_turn / speed;
      way = direction_or(rotation_of(off) * wanted, wanted);
    }
    for (int c : bone.colliders) {
      vec3 clear = keep_clear(character.spring_colliders[size_t(c)], character, frames,
                              {frame.center, length, bone.radius}, way);
      if (clear == way) continue;
      vec3 normal = direction_or(clear - way, vec3(0)), velocity = cross(turning, clear);
      // a bone that met it goes no further in
      velocity -= normal * std::min(dot(velocity, normal), 0.0f);
      turning = cross(clear, velocity);
      way = clear;
    }
    if (!is_finite(way) || !is_finite(turning) || !is_finite(frame.center))
      way = modelled, turning = vec3(0);
    quat back = glm::conjugate(base.rotation);
    own.end = back * (frame.center + way * length - base.center);
    own.turning = back * turning;
    quat parent_rotation = parent < 0 ? quat(1, 0, 0, 0) : frames[size_t(parent)].rotation;
    frame.rotation = glm::normalize(rotation_of(turn_vector(modelled, way)) * frame.rotation);
    pose.rotations[j] = glm::normalize(glm::conjugate(parent_rotation) * frame.rotation);
  }
}

}  // namespace wellspring::avatar
