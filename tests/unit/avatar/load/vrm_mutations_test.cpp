// SPDX-License-Identifier: Apache-2.0
// VRM models that lack what they should have, or say what they should not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "avatar/load/character_load.h"
#include "avatar/face/expression_rules.h"
#include "avatar/mind/storyteller.h"
#include "base/load_error.h"
#include "base/rng.h"
#include "unit/avatar/load/vrm_person.h"

namespace wellspring::test {
namespace {

using test::add_vrm_0;
using test::add_vrm_1;
using test::full_person_0;
using test::full_person_1;

// Only some bones are required, and files lack even those.
TEST(VrmMutations, FiguresWithoutSomeBonesStandAndBreathe) {
  for (size_t missing = 0; missing <= test::person_bones().size(); missing++) {
    Asset asset = dressed_person();
    add_vrm_1(asset);
    auto& bones = asset.root["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"];
    if (missing < test::person_bones().size()) bones.erase(test::person_bones()[missing].vrm);
    else bones = {{"hips", {{"node", 0}}}, {"head", {{"node", 4}}}};
    Character c = load_asset(asset);
    Storyteller storyteller{&c, mat4(1)};
    StorytellerState state;
    StorytellerInput input;
    StorytellerEvents events;
    Pose pose;
    for (int i = 0; i < 30; i++) {
      input.dt = 0.1f;
      input.time += 0.1;
      input.speaking = 1;
      tick_storyteller(state, storyteller, input, pose, events);
      for (quat q : pose.rotations) ASSERT_NEAR(glm::length(q), 1, 1e-3f) << missing;
      for (float w : pose.displacers) ASSERT_TRUE(std::isfinite(w)) << missing;
    }
  }
}

// Any part of the extensions replaced by anything: refused with a place, or loaded; posed without a
// crash.
// All places of the extensions, each with those it lies in.
std::vector<std::string> extension_places(const Asset& asset) {
  std::vector<std::string> places;
  const json flat = asset.root.flatten();
  for (const auto& [place, value] : flat.items())
    for (size_t end = place.size(); end != std::string::npos && end > 0;
         end = place.rfind('/', end - 1)) {
      std::string part = place.substr(0, end);
      bool ours = part.find("/VRM") != std::string::npos;
      if (ours && std::find(places.begin(), places.end(), part) == places.end())
        places.push_back(part);
    }
  return places;
}

// Does with a figure what a show does in a tick.
void use_figure(const Character& c, Rng& rng, const std::string& place) {
  Pose pose = make_rest_pose(c);
  for (float& w : pose.displacers) w = rng.uniform() * 2 - 0.5f;
  Storyteller storyteller{&c, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  input.dt = 0.05f;
  follow_expression_rules(c, pose);
  for (int appearance = 0; appearance < int(c.appearances.size()); appearance++) {
    AppearanceChange change = change_of(c, pose, size_t(appearance));
    ASSERT_TRUE(is_finite(vec3(change.base_color)) && is_finite(change.emission) &&
                is_finite(change.uv[2]))
        << place;
  }
  tick_storyteller(state, storyteller, input, pose, events);
  for (quat q : pose.rotations) ASSERT_NEAR(glm::length(q), 1, 1e-3f) << place;
}

TEST(VrmMutations, MutatedExtensionsNeverCrash) {
  const json poisons[] = {nullptr,
                          -1,
                          99,
                          3.5,
                          1e300,
                          "x",
                          "",
                          true,
                          json::array(),
                          json::object(),
                          json{{"x", 1}},
                          json{1, "y", nullptr},
                          0};
  Rng rng{20};
  int loaded = 0, refused = 0;
  for (const Asset& asset : {full_person_0(), full_person_1()}) {
    const std::vector<std::string> places = extension_places(asset);
    ASSERT_GT(places.size(), 60u);
    for (const std::string& place : places)
      for (int round = 0; round < 4; round++) {
        Asset changed = asset;
        changed.root[json::json_pointer(place)] = poisons[size_t(rng.uniform() * 12.99f)];
        try {
          Character c = load_asset(changed);
          loaded++;
          use_figure(c, rng, place);
        } catch (const LoadError& error) {
          refused++;
          ASSERT_FALSE(error.what_.empty());
        }
      }
  }
  EXPECT_GT(loaded, 100);
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace wellspring::test
