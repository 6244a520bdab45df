// SPDX-License-Identifier: Apache-2.0
// The story's layer of the storyteller: told again it is the same, whoever tells it and however
// often.
#include <gtest/gtest.h>

#include "avatar/load/character_load.h"
#include "show/storyteller/held_prop.h"
#include "show/storyteller/story_clip.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

StoryText make_story() {
  StoryText story{.id = "s"};
  story.text["en"] = read_story(
                         "<emotion name='joy'/>Once <gesture name='open_arms'/>there was a well. "
                         "<emotion name='sadness'/>It <emphasis>had</emphasis> no water.",
                         "a")
                         .lines;
  return story;
}

bool same(const std::vector<StoryMoment>& a, const std::vector<StoryMoment>& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); i++)
    if (a[i].time != b[i].time || a[i].sentence != b[i].sentence ||
        a[i].pose.rotations != b[i].pose.rotations ||
        a[i].pose.displacers != b[i].pose.displacers ||
        a[i].pose.translation != b[i].pose.translation)
      return false;
  return true;
}

TEST(StoryClip, ToldAgainItIsTheSame) {
  Exhibit exhibit = make_tiny_exhibit();
  Character character =
      load_character(std::string(WELLSPRING_SOURCE) + "/content/castle/figures/storyteller.x3d");
  for (bool humanlike : {false, true}) {
    ClipSettings settings{.humanlike = humanlike};
    auto first = act_story(exhibit, character, mat4(1), make_story(), {}, settings);
    auto second = act_story(exhibit, character, mat4(1), make_story(), {}, settings);
    ASSERT_GT(first.size(), 60u);
    EXPECT_TRUE(same(first, second));
  }
}

TEST(StoryClip, WhatTheBodyIsAskedForDependsOnTheStoryAlone) {
  Exhibit exhibit = make_tiny_exhibit();
  PointOfInterest& well = exhibit.points.emplace_back();
  well.id = "well", well.node = "Well", well.place = dvec3(1, 0.8, -2);
  StoryText story = make_story();
  story.text["en"] = read_story(
                         "<look at='well'/>One <point at='well'/>two. <gesture "
                         "name='nod'/>Three.<look at='visitor'/>",
                         "a")
                         .lines;
  struct Asked {
    int sentence;
    std::string emotion, gesture;
    bool look, point;
    uint32_t seed;
    bool operator==(const Asked&) const = default;
  };
  auto run = [&](float step, Voice& voice) {
    std::vector<Asked> asked;
    tell(voice, story);
    while (!voice.queue.empty()) {
      VoiceEvents said = advance_voice(voice, step);
      StoryCue cue = make_cue(exhibit, voice, said);
      Asked now{voice.sentence,       cue.emotion,           cue.gesture,
                cue.look.has_value(), cue.point.has_value(), cue.seed};
      if (!voice.queue.empty() && (asked.empty() || asked.back() != now)) asked.push_back(now);
      if (cue.look) {
        EXPECT_EQ(*cue.look, vec3(1, 0.8f, -2));
      }
    }
    return asked;
  };
  Voice fresh, used;
  say(used, plain_line({{"en", "Something else before."}}), false);
  advance_voice(used, 1);
  auto first = run(0.005f, fresh), second = run(0.0083f, used);
  EXPECT_EQ(first, second);
  EXPECT_GE(first.size(), 4u);
  EXPECT_NE(first[0].seed, 0u);
}

}  // namespace
}  // namespace wellspring::test
