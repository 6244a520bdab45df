// SPDX-License-Identifier: Apache-2.0
// A story acted without a show: what the storyteller's body does while it is told, moment by
// moment. For pictures to look at, and for tests that it is the same every time.
#pragma once
#include <memory>
#include <vector>

#include "avatar/speech/speech.h"
#include "avatar/mind/storyteller.h"
#include "show/exhibit/exhibit.h"

namespace wellspring::show {

struct StoryMoment {
  double time = 0;   // seconds from the beginning
  double sound = 0;  // place in the speech of the sentence that is told
  int sentence = 0;
  Pose pose;
};

struct ClipSettings {
  std::string lang = "en";
  double seconds = 1e9;  // ends earlier when the story does
  double fps = 30;
  bool humanlike = true;
  vec3 guest{0.2f, 1.6f, 1.6f};  // eyes of the one it is told to, humanoid space
};

// `spoken` are the speeches of the story's lines in that language; null: as long as they take to
// read. Objects of `exhibit` are looked and pointed at; its storyteller stands where the exhibit
// has it.
std::vector<StoryMoment> act_story(const Exhibit& exhibit, const Character& character,
                                   const mat4& placement, const StoryText& story,
                                   const std::vector<std::shared_ptr<const Speech>>& spoken,
                                   const ClipSettings& settings);

}  // namespace wellspring::show
