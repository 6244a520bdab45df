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

namespace wellspring {
namespace {

using test::add_vrm_0;
using test::add_vrm_1;
using test::change_of;
using test::dressed_person;
using test::load_asset;
using test::presets;

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
// People whose extensions have every field that the format has.
Asset full_person_1() {
  Asset asset = dressed_person();
  add_vrm_1(asset);
  json color = {{"material", 0}, {"type", "color"}, {"targetValue", {1, 0, 0.25, 1}}};
  presets(asset)["happy"] = {
      {"isBinary", true},
      {"overrideBlink", "block"},
      {"overrideLookAt", "blend"},
      {"materialColorBinds", {color}},
      {"textureTransformBinds", {{{"material", 0}, {"scale", {3, 0.5}}, {"offset", {0.75, 0.5}}}}}};
  presets(asset)["blink"] = presets(asset)["aa"];
  asset.root["extensions"]["VRMC_vrm"]["firstPerson"]["meshAnnotations"] = {
      {{"node", 17}, {"type", "both"}}};
  asset.root["nodes"][3]["extensions"]["VRMC_node_constraint"] = {
      {"specVersion", "1.0"},
      {"constraint", {{"roll", {{"source", 2}, {"rollAxis", "Y"}, {"weight", 0.5}}}}}};
  asset.root["nodes"][7]["extensions"]["VRMC_node_constraint"] = {
      {"specVersion", "1.0"}, {"constraint", {{"aim", {{"source", 4}, {"aimAxis", "PositiveX"}}}}}};
  asset.root["materials"][0]["extensions"]["VRMC_materials_mtoon"] = {
      {"outlineWidthMode", "none"}, {"shadeColorFactor", {0, 0, 0}}};
  return asset;
}

Asset full_person_0() {
  Asset asset = dressed_person();
  add_vrm_0(asset);
  auto& vrm = asset.root["extensions"]["VRM"];
  vrm["blendShapeMaster"]["blendShapeGroups"][0]["materialValues"] = {
      {{"materialName", "skin"}, {"propertyName", "_Color"}, {"targetValue", {0.5, 0, 1, 1}}},
      {{"materialName", "skin"},
       {"propertyName", "_MainTex_ST"},
       {"targetValue", {1, 0.25, 0.5, 0.25}}}};
  vrm["firstPerson"] = {{"lookAtTypeName", "BlendShape"},
                        {"lookAtVerticalUp", {{"xRange", 60}, {"yRange", 1}}},
                        {"meshAnnotations", {{{"mesh", 0}, {"firstPersonFlag", "Auto"}}}}};
  vrm["materialProperties"] = {
      {{"shader", "VRM/MToon"},
       {"floatProperties", {{"_Cutoff", 0.5}}},
       {"vectorProperties", {{"_Color", {1, 1, 1, 1}}, {"_MainTex", {0, 0, 1, 1}}}},
       {"textureProperties", {{"_MainTex", 0}}},
       {"keywordMap", {{"_ALPHATEST_ON", true}}}}};
  return asset;
}

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

// What a show does with a figure in a tick.
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
}  // namespace wellspring
