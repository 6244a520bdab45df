// SPDX-License-Identifier: Apache-2.0
// Who listens is never shown a back: all stories of the content, told to somebody who stands before
// the storyteller.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "avatar/mind/storyteller.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/moving/exhibit_scene.h"
#include "show/storyteller/held_prop.h"

namespace wellspring::test {
namespace {

const Exhibit& content_package(const std::string& name) {
  static std::map<std::string, Exhibit> loaded;
  auto [place, added] = loaded.try_emplace(name);
  if (added) {
    std::vector<Problem> problems;
    place->second = read_exhibit(std::string(WELLSPRING_SOURCE) + "/content/" + name, problems);
  }
  return place->second;
}

float turn_between(float a, float b) { return std::abs(std::remainder(a - b, 2 * pi)); }

// Drives a storyteller who tells a story, as the show does.
struct Telling {
  const Exhibit& exhibit;
  const StorytellerPlace& place;
  std::string lang;
  Storyteller storyteller{&place.character, place_storyteller(place, exhibit.scene)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  Voice voice;

  void tick(double dt) {
    AskSpeech ask = [&](const Utterance&) { return SpeechState{nullptr, false, lang}; };
    VoiceEvents said = advance_voice(voice, float(dt), ask);
    input.dt = float(dt);
    input.time += dt;
    input.telling = !voice.story.empty();
    input.speaking = speaking(voice);
    input.story = make_cue(exhibit, voice, said);
    tick_storyteller(state, storyteller, input, pose, events);
  }
  vec3 here(vec3 world) const { return vec3(glm::inverse(storyteller.placement) * vec4(world, 1)); }
  // Returns the yaw of the skull or the root, humanoid space.
  float yaw(int joint) const {
    vec3 ahead = eval_joint_frame(place.character, pose, joint).rotation * vec3(0, 0, 1);
    return std::atan2(ahead.x, ahead.z);
  }
  float away(int joint, vec3 guest) const {  // from the first guest
    vec3 from = eval_joint_frame(place.character, pose, joint).center, to = here(guest) - from;
    return turn_between(yaw(joint), std::atan2(to.x, to.z));
  }
};

struct Seen {
  float face = 0, body = 0;  // farthest from the listener, radians
};

Seen tell_to(Telling& telling, const StoryText& story, vec3 listener, bool kiosk) {
  telling.input.guests = {{1, listener, vec3(0), kiosk}};
  for (int i = 0; i < 150; i++) telling.tick(1 / 30.0);  // greeted before
  tell(telling.voice, story);
  Seen seen;
  const Rig& rig = *telling.state.rig;
  for (int i = 0; i < 12000 && !telling.voice.queue.empty(); i++) {
    telling.tick(1 / 30.0);
    seen.face = std::max(seen.face, telling.away(rig.skull, listener));
    seen.body = std::max(seen.body, telling.away(rig.root, listener));
  }
  EXPECT_TRUE(telling.voice.queue.empty());
  return seen;
}

TEST(Facing, NoStoryOfTheContentTurnsItsBackToWhoListens) {
  float worst = 0;
  for (const char* name : {"castle", "chapel", "first-room"}) {
    const Exhibit& exhibit = content_package(name);
    if (exhibit.storytellers.empty()) continue;  // its stories are told without a figure
    for (const StoryText& story : exhibit.stories)
      for (const auto& [lang, lines] : story.text)
        for (bool kiosk : {true, false}) {
          const size_t who = size_t(std::max(story.storyteller_index, 0));
          const StorytellerPlace& place = exhibit.storytellers[who];
          StoryText one = story;
          one.text = {{lang, lines}};
          const Viewpoint& view = exhibit.viewpoints[size_t(place.kiosk_viewpoint)].view;
          Telling telling{exhibit, place, lang};
          Seen seen = tell_to(telling, one, vec3(view.position - exhibit.scene.origin), kiosk);
          EXPECT_LT(seen.face, 75_deg) << name << " " << story.id << " " << lang << " " << kiosk;
          EXPECT_LT(seen.body, 40_deg) << name << " " << story.id << " " << lang << " " << kiosk;
          worst = std::max(worst, seen.face);
        }
  }
  RecordProperty("worst_degrees", std::to_string(worst / 1_deg));
}

}  // namespace
}  // namespace wellspring::test
