// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/held_prop.h"

#include <algorithm>

#include "avatar/figure/noise.h"
#include "show/exhibit/exhibit_objects.h"
#include "show/lighting/day.h"

namespace wellspring::show {
namespace {

uint32_t channel_of(int prop) { return 7000 + 8 * uint32_t(prop); }

// How far a flickering flame is from where it is drawn, metres.
vec3 eval_sway(double time, uint32_t channel, const Flicker& flicker) {
  constexpr float reach = 0.04f;
  auto noise = [&](uint32_t axis) { return smooth_noise(channel + axis, 1.7 * time); };
  return reach * flicker.depth * vec3(noise(1), 0.5f * noise(2), noise(3));
}

}  // namespace

HeldThing find_held_thing(const Exhibit& exhibit, const std::string& prop) {
  const int found = prop.empty() ? -1 : find_prop(exhibit, prop);
  if (found < 0) return {};
  const ExhibitProp& one = exhibit.props[size_t(found)];
  return {found, one.gesture, one.side};
}

void advance_held(const Exhibit& exhibit, const Storyteller& storyteller,
                  const StorytellerState& state, const Pose& pose, bool visible, float dt,
                  HeldProp& held) {
  const GestureLibrary& library = storyteller.gestures ? *storyteller.gestures : default_gestures();
  const int thing = state.hold.held.thing;
  const bool known = thing >= 0 && size_t(thing) < exhibit.props.size();
  const std::optional<mat4> grip =
      known && visible ? eval_grip(state, storyteller, pose) : std::nullopt;
  const bool changes = grip && thing != held.prop;
  if (changes && held.glow <= 0) held.prop = thing;  // else its light goes out first
  const bool here = grip && thing == held.prop;
  if (here) held.to_world = *grip;
  held.size = here ? eval_held_share(state.hold, library) : 0;
  const float wanted = here && is_held_up(state.hold, library) ? 1.0f : 0.0f;
  const float step = dt / glow_seconds;
  held.glow += std::clamp(wanted - held.glow, -step, step);
  if (!here && held.glow <= 0) held = {};
}

PropPose pose_of(const Exhibit& exhibit, const HeldProp& held, int prop, double time) {
  if (prop < 0 || prop != held.prop) return {};
  // Never higher than the file has it: the light above would be inside.
  const Flicker& flicker = exhibit.props[size_t(prop)].flicker;
  const float height = eval_flicker(flicker, channel_of(prop), time) / (1 + flicker.depth);
  return {held.to_world, held.size, held.glow * height};
}

void add_held_lights(const Exhibit& exhibit, const HeldProp& held, double time, uint32_t first_id,
                     DynamicLights& lights) {
  if (held.prop < 0 || held.glow <= 0) return;
  const ExhibitProp& prop = exhibit.props[size_t(held.prop)];
  const mat4 to_world = held.to_world * prop.to_fist;
  const uint32_t channel = channel_of(held.prop);
  const float strength =
      held.glow * held.glow * (3 - 2 * held.glow) * eval_flicker(prop.flicker, channel, time);
  const vec3 sway = eval_sway(time, channel, prop.flicker);
  for (size_t i = 0; i < prop.scene.lights.size(); i++) {
    DynamicLight one;
    one.light = prop.scene.lights[i];
    one.light.position = vec3(to_world * vec4(one.light.position, 1)) + sway;
    one.light.direction = normalize(mat3(to_world) * one.light.direction);
    one.light.intensity *= strength;
    one.id = first_id + uint32_t(held.prop) * uint32_t(most_prop_lights) + uint32_t(i);
    if (max_component(one.light.intensity) > 0) lights.push_back(std::move(one));
  }
}

namespace {

std::optional<vec3> place_of(const Exhibit& exhibit, const std::string& object) {
  const PointOfInterest* point = object.empty() ? nullptr : find_point(exhibit, object);
  if (!point) return {};
  return vec3(point->place - exhibit.scene.origin);
}

// FNV-1a: the same story begins from the same seed on every machine.
uint32_t seed_of(const std::string& story) {
  uint32_t hash = 2166136261u;
  for (char c : story) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

}  // namespace

StoryCue make_cue(const Exhibit& exhibit, const Voice& voice, const VoiceEvents& events) {
  StoryCue cue;
  if (voice.queue.empty()) return cue;
  cue.emotion = voice.held.emotion;
  cue.emotion_weight = voice.held.emotion_weight;
  cue.look = place_of(exhibit, voice.held.look);
  cue.point = place_of(exhibit, voice.held.point);
  cue.held = find_held_thing(exhibit, voice.held.prop);
  if (!voice.story.empty()) cue.seed = seed_of(voice.story);
  for (const ActionEvent& act : events.acts) {
    if (act.kind == StoryMarkKind::gesture) {
      cue.gesture = act.name;
      cue.gesture_weight = act.weight;
      cue.gesture_lead = act.lead;
    } else if (act.kind == StoryMarkKind::beat) {
      cue.beat = std::max(cue.beat, act.weight);
    }
  }
  return cue;
}

}  // namespace wellspring::show
