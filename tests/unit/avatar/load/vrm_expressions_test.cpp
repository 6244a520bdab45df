// SPDX-License-Identifier: Apache-2.0
// What VRM's expressions do besides moving vertices: materials they change, what they forbid, how
// eyes turn.
#include <gtest/gtest.h>

#include "avatar/body/body.h"
#include "avatar/face/expression_rules.h"
#include "avatar/face/expression_sum.h"
#include "avatar/figure/figure_check.h"
#include "avatar/load/character_load.h"
#include "avatar/load/vrm_extension.h"
#include "avatar/mind/storyteller.h"
#include "base/load_error.h"
#include "unit/avatar/load/vrm_person.h"

namespace wellspring::test {
namespace {

using test::add_vrm_0;
using test::add_vrm_1;

Pose with(const Character& c, std::initializer_list<std::pair<const char*, float>> weights) {
  Pose pose = make_rest_pose(c);
  for (const auto& [name, weight] : weights) {
    int index = find_displacer(c, name);
    EXPECT_GE(index, 0) << name;
    if (index >= 0) pose.displacers[size_t(index)] = weight;
  }
  return pose;
}

float weight_of(const Character& c, const Pose& pose, const char* name) {
  int index = find_displacer(c, name);
  EXPECT_GE(index, 0) << name;
  return index < 0 ? NAN : pose.displacers[size_t(index)];
}

TEST(VrmExpressions, Version1ChangesColoursAndWherePicturesLie) {
  Asset asset = dressed_person();
  add_vrm_1(asset);
  presets(asset)["happy"] = {
      {"materialColorBinds",
       {{{"material", 0}, {"type", "color"}, {"targetValue", {1, 0, 0.25, 1}}},
        {{"material", 0}, {"type", "emissionColor"}, {"targetValue", {0.6, 1, 0, 1}}},
        {{"material", 1}, {"type", "rimColor"}, {"targetValue", {1, 1, 1, 1}}}}}};
  presets(asset)["sad"] = {
      {"textureTransformBinds", {{{"material", 0}, {"scale", {3, 0.5}}, {"offset", {0.75, 0.5}}}}}};
  Character c = load_asset(asset);
  EXPECT_TRUE(says(c, "rim, matcap and outline colours"));
  EXPECT_NE(describe_text(c).find("2 displacers change materials: happy, sad"), std::string::npos)
      << describe_text(c);
  AppearanceChange none = change_of(c, make_rest_pose(c), 1);
  EXPECT_EQ(none.base_color, vec4(0));
  EXPECT_EQ(none.uv, mat3(0.0f));
  AppearanceChange change = change_of(c, with(c, {{"happy", 0.5f}, {"sad", 1}}), 1);
  vec4 wanted = 0.5f * vec4(0.5f, -0.4f, 0, 0.5f);
  for (int i = 0; i < 4; i++) EXPECT_NEAR(change.base_color[i], wanted[i], 1e-6f) << i;
  vec3 glow = 0.5f * 4.0f * vec3(0.5f, 1, 0);
  for (int i = 0; i < 3; i++) EXPECT_NEAR(change.emission[i], glow[i], 1e-5f) << i;
  // The matrix that KHR_texture_transform would make of the new numbers, less the old one.
  auto matrix = [](vec2 scale, vec2 offset) {
    float cosine = std::cos(0.3f), sine = std::sin(0.3f);
    return mat3(cosine * scale.x, -sine * scale.x, 0, sine * scale.y, cosine * scale.y, 0, offset.x,
                offset.y, 1);
  };
  mat3 uv = matrix({3, 0.5f}, {0.75f, 0.5f}) - matrix({2, 0.5f}, {0.25f, 0});
  for (int i = 0; i < 9; i++) EXPECT_NEAR(change.uv[i / 3][i % 3], uv[i / 3][i % 3], 1e-6f) << i;
  EXPECT_EQ(change_of(c, with(c, {{"happy", 1}}), 2).base_color, vec4(0)) << "of another look";
  EXPECT_EQ(change_of(c, with(c, {{"happy", 7}}), 1).base_color,
            change_of(c, with(c, {{"happy", 1}}), 1).base_color);
  EXPECT_EQ(change_of(c, with(c, {{"happy", NAN}}), 1).base_color, vec4(0));
}

TEST(VrmExpressions, Version0NamesMaterialsInUnitysTerms) {
  test::PersonOptions options;
  Asset asset = dressed_person();
  add_vrm_0(asset);
  json values = {
      {{"materialName", "skin"}, {"propertyName", "_Color"}, {"targetValue", {0.5, 0, 1, 1}}},
      {{"materialName", "skin"}, {"propertyName", "_EmissionColor"}, {"targetValue", {2, 0, 0, 1}}},
      {{"materialName", "skin"},
       {"propertyName", "_MainTex_ST"},
       {"targetValue", {1, 0.25, 0.5, 0.25}}},
      {{"materialName", "ring"},
       {"propertyName", "_MainTex_ST_S"},
       {"targetValue", {1, 1, 0.5, 0}}},
      {{"materialName", "ghost"}, {"propertyName", "_Color"}, {"targetValue", {1, 1, 1, 1}}},
      {{"materialName", "skin"}, {"propertyName", "_ShadeColor"}, {"targetValue", {1, 1, 1, 1}}}};
  asset.root["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"].push_back(
      {{"name", "Joy"}, {"presetName", "joy"}, {"isBinary", true}, {"materialValues", values}});
  auto& materials = asset.root["materials"];
  materials[0]["pbrMetallicRoughness"]["baseColorTexture"].erase("extensions");
  Character c = load_asset(asset);
  EXPECT_TRUE(says(c, "materials that the file has not"));
  EXPECT_TRUE(says(c, "shade, rim, matcap"));
  AppearanceChange change = change_of(c, with(c, {{"happy", 1}}), 1);
  EXPECT_NEAR(change.base_color.x, 0.21404f - 0.5f, 1e-4f) << "0.5 of sRGB";
  EXPECT_NEAR(change.base_color.z, 1 - 0.25f, 1e-6f);
  EXPECT_NEAR(change.emission.x, (std::pow(2.0f, 2.2f) - 0.1f) * 4, 1e-3f);
  EXPECT_NEAR(change.uv[0].x, 0, 1e-6f);
  EXPECT_NEAR(change.uv[1].y, 0.25f - 1, 1e-6f);
  EXPECT_NEAR(change.uv[2].x, 0.5f, 1e-6f);
  EXPECT_NEAR(change.uv[2].y, 1 - 0.25f - 0.25f, 1e-6f) << "from above as glTF has it";
  AppearanceChange ring = change_of(c, with(c, {{"happy", 1}}), 2);
  EXPECT_NEAR(ring.uv[2].x, 0.5f, 1e-6f);
  EXPECT_EQ(ring.uv[1], vec3(0)) << "one axis alone";
  EXPECT_EQ(ring.uv[2].y, 0);
  ASSERT_FALSE(c.expression_rules.empty());
  EXPECT_TRUE(c.expression_rules[0].binary);
}

// A file that blinks and speaks by pictures alone: controls made of its expressions change them,
// too.
TEST(VrmExpressions, ControlsMadeOfExpressionsChangeMaterialsToo) {
  Asset asset = dressed_person();
  add_vrm_1(asset);
  auto shift = [](double u) {
    return json{
        {"textureTransformBinds", {{{"material", 0}, {"scale", {2, 0.5}}, {"offset", {u, 0}}}}}};
  };
  presets(asset)["blink"] = shift(0.5);
  presets(asset)["aa"] = shift(0.75);
  presets(asset)["aa"]["isBinary"] = true;
  presets(asset)["ou"] = shift(1.25);
  Character c = load_asset(asset);
  Rig rig = make_rig(c);
  ASSERT_GE(rig.blink[0], 0);
  ASSERT_GE(rig.viseme[10], 0);
  auto moved = [&](std::initializer_list<std::pair<const char*, float>> weights) {
    Pose pose = with(c, weights);
    follow_expression_rules(c, pose);
    return change_of(c, pose, 1).uv[2].x;
  };
  EXPECT_NEAR(moved({{"blink_l", 1}, {"blink_r", 1}}), 0.25f, 1e-6f)
      << "both lids are the whole blink";
  EXPECT_NEAR(moved({{"viseme_ou", 0.5f}}), 0.5f, 1e-6f);
  EXPECT_EQ(moved({{"viseme_aa", 0.5f}}), 0) << "all or nothing";
  EXPECT_NEAR(moved({{"viseme_aa", 0.6f}}), 0.5f, 1e-6f);
  EXPECT_LT(find_displacer(c, "viseme_kk"), 0) << "there is no little of what is all or nothing";
}

TEST(VrmExpressions, ForbidBlinksGazeAndSpeechAsTheFormatSays) {
  Asset asset = dressed_person();
  add_vrm_1(asset);
  json mouth = presets(asset)["aa"];
  for (const char* name :
       {"happy", "angry", "sad", "relaxed", "surprised", "blink", "blinkLeft", "lookUp", "oh"})
    presets(asset)[name] = mouth;
  presets(asset)["happy"]["overrideBlink"] = "blend";
  presets(asset)["angry"]["overrideBlink"] = "blend";
  presets(asset)["sad"]["overrideMouth"] = "block";
  presets(asset)["relaxed"]["overrideLookAt"] = "block";
  presets(asset)["relaxed"]["isBinary"] = true;
  presets(asset)["oh"]["isBinary"] = true;
  presets(asset)["surprised"]["overrideMouth"] = "blend";
  presets(asset)["blink"]["overrideBlink"] = "block";  // blocks its own kind: does not count
  Character c = load_asset(asset);
  auto after = [&](std::initializer_list<std::pair<const char*, float>> weights) {
    Pose pose = with(c, weights);
    follow_expression_rules(c, pose);
    return pose;
  };
  Pose pose = after({{"happy", 0.25f},
                     {"angry", 0.5f},
                     {"blink", 0.8f},
                     {"blinkLeft", 1},
                     {"blink_r", 1},
                     {"aa", 1}});
  EXPECT_NEAR(weight_of(c, pose, "blink"), 0.8f * 0.25f, 1e-6f);
  EXPECT_NEAR(weight_of(c, pose, "blinkLeft"), 0.25f, 1e-6f);
  EXPECT_NEAR(weight_of(c, pose, "blink_r"), 0.25f, 1e-6f) << "what was made of it likewise";
  EXPECT_EQ(weight_of(c, pose, "aa"), 1) << "of another kind";
  EXPECT_EQ(weight_of(c, after({{"happy", 0.7f}, {"angry", 0.7f}, {"blink", 1}}), "blink"), 0)
      << "not below 0";
  EXPECT_EQ(weight_of(c, after({{"blink", 0.9f}}), "blink"), 0.9f)
      << "a blink does not forbid itself";
  pose = after({{"sad", 0.01f}, {"aa", 1}, {"viseme_aa", 0.7f}, {"blink", 1}});
  EXPECT_EQ(weight_of(c, pose, "aa") + weight_of(c, pose, "viseme_aa"), 0)
      << "a little of it blocks all";
  EXPECT_EQ(weight_of(c, pose, "blink"), 1);
  // All or nothing, as it shows and not as it was asked for.
  EXPECT_EQ(weight_of(c, after({{"relaxed", 0.5f}, {"lookUp", 0.5f}}), "lookUp"), 0.5f);
  EXPECT_EQ(weight_of(c, after({{"relaxed", 0.51f}, {"lookUp", 0.5f}}), "lookUp"), 0);
  EXPECT_EQ(weight_of(c, after({{"relaxed", 0.51f}}), "relaxed"), 1);
  EXPECT_EQ(weight_of(c, after({{"surprised", 0.1f}, {"oh", 0.9f}}), "oh"), 0)
      << "overridden a little: wholly";
  EXPECT_NEAR(weight_of(c, after({{"surprised", 0.1f}, {"aa", 0.5f}}), "aa"), 0.45f, 1e-6f);
  EXPECT_EQ(weight_of(c, after({{"happy", NAN}, {"blink", 1}}), "blink"), 1);
}

TEST(VrmExpressions, AFigureThatAsksForNothingIsLeftAlone) {
  Asset asset = dressed_person();
  add_vrm_1(asset);
  Character c = load_asset(asset);
  EXPECT_TRUE(c.expression_rules.empty());
  EXPECT_TRUE(c.appearance_changes.empty());
  EXPECT_TRUE(c.constraints.empty());
  Pose pose = with(c, {{"aa", 0.3f}});
  std::vector<float> before = pose.displacers;
  follow_expression_rules(c, pose);
  EXPECT_EQ(pose.displacers, before);
}

// If an expression and a morph target have one name, however it is spelt, the expression counts.
TEST(VrmExpressions, ComeBeforeMorphTargetsOfTheirName) {
  Asset asset = dressed_person();
  add_vrm_1(asset);
  asset.root["meshes"][0]["extras"]["targetNames"][0] = "AA";
  Character c = load_asset(asset);
  ExpressionRig rig = make_expression_rig(default_expressions(), c);
  Rig body = make_rig(c);
  ASSERT_GE(body.viseme[10], 0);
  EXPECT_NEAR(c.displacers[size_t(body.viseme[10])].displacements[0].y, -0.01f, 1e-6f)
      << "half of the target";
  asset.root["meshes"][0]["extras"]["targetNames"][0] = "aa";
  c = load_asset(asset);
  EXPECT_NEAR(c.displacers[size_t(find_displacer(c, "aa"))].displacements[0].y, -0.01f, 1e-6f);
  EXPECT_EQ(std::count_if(c.displacers.begin(), c.displacers.end(),
                          [](const Displacer& d) { return d.name == "aa"; }),
            1);
}

TEST(VrmExpressions, EyesTurnByBonesOrByShapesWithinTheirRanges) {
  Asset asset = make_person();
  add_vrm_1(asset);
  for (const char* appearance : {"lookUp", "lookDown", "lookLeft", "lookRight"})
    presets(asset)[appearance] = presets(asset)["aa"];
  json range = {{"inputMaxValue", 30}, {"outputScale", 0.8}};
  asset.root["extensions"]["VRMC_vrm"]["lookAt"] = {
      {"type", "expression"},
      {"rangeMapHorizontalInner", {{"inputMaxValue", 1}, {"outputScale", 1}}},
      {"rangeMapHorizontalOuter", range},
      {"rangeMapVerticalUp", range},
      {"rangeMapVerticalDown", {{"inputMaxValue", 0}, {"outputScale", 9}}}};
  Character c = load_asset(asset);
  ASSERT_TRUE(c.eye_ranges.by_shapes);
  Rig rig = make_rig(c);
  auto look_at = [&](vec3 way) {
    Pose pose = make_rest_pose(c);
    aim_eyes(rig, rig.eyes_center + way, pose);
    return pose;
  };
  Pose pose = look_at({std::sin(15_deg), 0, std::cos(15_deg)});
  EXPECT_NEAR(weight_of(c, pose, "lookLeft"), 0.4f, 1e-4f) << "by the outer range, whichever eye";
  EXPECT_EQ(weight_of(c, pose, "lookRight"), 0);
  EXPECT_NEAR(weight_of(c, look_at({-1, 0, 0.1f}), "lookRight"), 0.8f, 1e-5f);
  EXPECT_NEAR(weight_of(c, look_at({0, std::sin(10_deg), std::cos(10_deg)}), "lookUp"), 0.8f / 3,
              1e-4f);
  EXPECT_EQ(weight_of(c, look_at({0, -0.5f, 1}), "lookDown"), 1) << "a weight is never more than 1";

  // Version 0 in its own words.
  Asset older = make_person();
  add_vrm_0(older);
  json straight = {0, 0, 0, 1, 1, 1, 1, 0};
  older.root["extensions"]["VRM"]["firstPerson"] = {
      {"lookAtTypeName", "Bone"},
      {"lookAtHorizontalInner", {{"curve", straight}, {"xRange", 60}, {"yRange", 12}}},
      {"lookAtVerticalUp", {{"curve", {0, 0, 2, 2, 1, 1, 0, 0}}, {"xRange", 45}, {"yRange", 90}}}};
  c = load_asset(older);
  EXPECT_FALSE(c.eye_ranges.by_shapes);
  EXPECT_NEAR(c.eye_ranges.inner.most, 60_deg, 1e-5f);
  EXPECT_NEAR(c.eye_ranges.inner.output, 12_deg, 1e-5f);
  EXPECT_NEAR(c.eye_ranges.up.output, 60_deg, 1e-5f) << "an eye turns no further";
  EXPECT_TRUE(says(c, "not along a curve of their own"));
  older.root["extensions"]["VRM"]["firstPerson"]["lookAtVerticalUp"]["curve"] = straight;
  EXPECT_FALSE(says(load_asset(older), "curve"));
}

TEST(VrmExpressions, WhatOnlyTheWearerSeesIsNotShown) {
  Asset asset = make_person();
  add_vrm_1(asset);
  asset.root["meshes"].push_back(asset.root["meshes"][0]);
  asset.root["nodes"].push_back({{"mesh", 1}, {"skin", 0}, {"name", "Hands"}});
  asset.root["scenes"][0]["nodes"].push_back(18);
  size_t both = load_asset(asset).positions.size();
  auto note = [&](const char* type) {
    asset.root["extensions"]["VRMC_vrm"]["firstPerson"]["meshAnnotations"] = {
        {{"node", 18}, {"type", type}}};
    return load_asset(asset).positions.size();
  };
  EXPECT_EQ(note("thirdPersonOnly"), both);
  EXPECT_EQ(note("auto"), both);
  EXPECT_EQ(note("firstPersonOnly"), both / 2);
  asset.root["extensions"].erase("VRMC_vrm");
  add_vrm_0(asset);
  asset.root["extensions"]["VRM"]["firstPerson"]["meshAnnotations"] = {
      {{"mesh", 1}, {"firstPersonFlag", "FirstPersonOnly"}}};
  EXPECT_EQ(load_asset(asset).positions.size(), both / 2);
}

// Two nodes hold one mesh: version 1 names the node whose targets move, version 0 the mesh.
TEST(VrmExpressions, BindsMoveTheNodesTheyName) {
  Asset asset = make_person();
  asset.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}, {"name", "Twin"}});
  asset.root["scenes"][0]["nodes"].push_back(18);
  Asset older = asset;
  add_vrm_1(asset);
  add_vrm_0(older);
  Character one = load_asset(asset), both = load_asset(older);
  size_t half = one.displacers[size_t(find_displacer(one, "aa"))].vertices.size();
  EXPECT_GT(half, 0u);
  EXPECT_EQ(both.displacers[size_t(find_displacer(both, "aa"))].vertices.size(), 2 * half);
}

}  // namespace
}  // namespace wellspring::test
