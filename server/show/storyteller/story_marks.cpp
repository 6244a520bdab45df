// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/story_marks.h"

#include <algorithm>

#include "show/storyteller/held_prop.h"

namespace wellspring::show {

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
