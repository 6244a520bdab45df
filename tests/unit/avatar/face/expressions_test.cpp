// SPDX-License-Identifier: Apache-2.0
// The expression language as data, and how it finds its way to a figure.
#include <gtest/gtest.h>

#include "avatar/face/expression_sum.h"
#include "avatar/speech/visemes.h"
#include "base/load_error.h"

namespace wellspring::test {
namespace {

TEST(Expressions, TheSetHasTheSixTheVisemesAndWhatAFaceDoes) {
  const ExpressionSet& set = default_expressions();
  for (std::string_view name : emotion_names) EXPECT_GE(find_expression(set, name), 0) << name;
  for (const char* name : viseme_names)
    EXPECT_GE(find_expression(set, std::string("viseme_") + name), 0) << name;
  for (const char* name :
       {"blink",      "blink_l",    "blink_r",    "brows_up",   "brows_down", "brows_worried",
        "squint",     "eyes_wide",  "smile",      "frown",      "sneer",      "pucker",
        "mouth_wide", "lips_press", "mouth_open", "cheek_puff", "wink",       "contempt",
        "interest",   "concern",    "head_nod",   "head_turn",  "head_tilt",  "breathe"})
    EXPECT_GE(find_expression(set, name), 0) << name;
}

TEST(Expressions, BadFilesAreRefusedWithTheirPlace) {
  auto head = [](const std::string& rest) {
    return "{\"format\":\"wellspring-expressions\",\"version\":1," + rest + "}";
  };
  struct Case {
    std::string text, where;
  };
  const std::string rotator =
      R"("rotators":[{"name":"r","joint":"skullbase","weight_ranges":[0,1],"orientations":[[0,0,1,0],[1,0,0,1]]}],)";
  const Case cases[] = {
      {"{", ""},
      {"{\"format\":\"wellspring-gestures\",\"version\":1}", "/format"},
      {head("\"expresions\":[]"), "/expresions"},
      {head(
           R"("rotators":[{"name":"r","joint":"j","weight_ranges":[0,0],"orientations":[[0,0,1,0],[0,0,1,0]]}])"),
       "/rotators/0/weight_ranges/1"},
      {head(R"("rotators":[{"name":"r","joint":"j","weight_ranges":[0],"orientations":[]}])"),
       "/rotators/0/orientations"},
      {head(
           R"("rotators":[{"name":"r","joint":"j","weight_ranges":[0],"orientations":[[0,0,0,1]]}])"),
       "/rotators/0/orientations/0"},
      {head(
           R"("rotators":[{"name":"r","joint":"j","weight_ranges":[0],"orientations":[[0,0,1,1e400]]}])"),
       ""},
      {head(R"("controls":[{"name":"c","kind":"nose"}])"), "/controls/0/kind"},
      {head(R"("controls":[{"name":"c"},{"name":"c"}])"), "/controls/1/name"},
      {head(R"("controls":[{"name":"c","rotator":"r"}])"), "/controls/0/rotator"},
      {head(rotator + R"("expressions":[{"name":"e","rotate":[{"rotator":"r","weight":null}]}])"),
       "/expressions/0/rotate/0/weight"},
      {head(R"("expressions":[{"name":"e","deform":[{"control":"c"}]}])"),
       "/expressions/0/deform/0/control"},
      {head(R"("expressions":[{"name":"e","group":[{"expression":"e"}]}])"),
       "/expressions/0/group/0/expression"},
      {head(R"("expressions":[{"name":"e"}])"), "/expressions/0"},
      {head(R"("expressions":[{"name":"e","group":[],"deform":[]}])"), "/expressions/0"},
      {head(R"("expressions":[{"name":"e","group":[],"otherwise":"f"}])"),
       "/expressions/0/otherwise"},
      {head(R"("expressions":[{"name":"","group":[]}])"), "/expressions/0/name"},
  };
  for (const Case& bad : cases) try {
      read_expressions(bad.text, "bad.json");
      ADD_FAILURE() << "accepted: " << bad.text;
    } catch (const LoadError& error) {
      EXPECT_EQ(error.where, bad.where) << error.what();
    }
}

Character with_displacers(std::initializer_list<const char*> names) {
  Character character;
  character.joints.push_back({});
  for (const char* name : names) character.displacers.push_back({name, {}, {}});
  return character;
}

std::vector<float> shown(const Character& character, const char* expression, float weight = 1) {
  ExpressionRig rig = make_expression_rig(default_expressions(), character);
  ExpressionSum sum;
  clear(sum, rig);
  add(sum, rig, find_expression(*rig.set, expression), weight);
  Pose pose = make_rest_pose(character);
  apply_rotators(sum, rig, pose);
  apply_controls(sum, rig, pose);
  return pose.displacers;
}

TEST(Expressions, FiguresOfOtherMakersAreUnderstood) {
  // Apple's names, with sides.
  Character arkit = with_displacers({"mouthSmileLeft", "mouthSmileRight", "jawOpen"});
  EXPECT_GT(shown(arkit, "joy")[0], 0.5f);
  EXPECT_EQ(shown(arkit, "smile_l")[1], 0);
  EXPECT_GT(shown(arkit, "viseme_aa")[2], 0.4f) << "no viseme of its own: made of the jaw";
  // VRM presets: the maker's own joy, five vowels, one blink for both eyes.
  Character vrm = with_displacers({"happy", "aa", "ih", "ou", "ee", "oh", "blink"});
  EXPECT_EQ(shown(vrm, "joy")[0], 1);
  EXPECT_EQ(shown(vrm, "viseme_E")[4], 1);
  EXPECT_NEAR(shown(vrm, "viseme_nn")[2], 0.15f, 1e-6f);
  EXPECT_NEAR(shown(vrm, "blink_l")[6], 0.5f, 1e-6f);
  EXPECT_NEAR(shown(vrm, "blink")[6], 1, 1e-6f);
  // VRM 0.x.
  Character old = with_displacers({"Joy", "A", "I", "U", "E", "O", "Blink_L", "Blink_R"});
  EXPECT_EQ(shown(old, "joy")[0], 1);
  EXPECT_EQ(shown(old, "viseme_aa")[1], 1);
  EXPECT_EQ(shown(old, "viseme_E")[4], 1);
  EXPECT_EQ(shown(old, "blink_r")[7], 1);
}

TEST(Expressions, WhatAFigureLacksIsSaidOnceAndLeftOut) {
  Character bare = with_displacers({"smile"});
  ExpressionRig rig = make_expression_rig(default_expressions(), bare);
  std::vector<std::string> sorted = rig.missing;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
  EXPECT_FALSE(sorted.empty());
  EXPECT_TRUE(shows(rig, find_expression(*rig.set, "joy")));
  EXPECT_FALSE(shows(rig, find_expression(*rig.set, "brows_up")));
  EXPECT_NEAR(shown(bare, "smile")[0], 1, 1e-6f);
  EXPECT_EQ(shown(bare, "cheek_puff")[0], 0);
}

TEST(Expressions, LidsAndJawsOfFiguresWithJointsTurn) {
  Character character;
  for (const char* name : {"humanoid_root", "skullbase", "l_eyelid_joint", "temporomandibular"}) {
    character.joints.push_back({.name = name,
                                .parent = character.joints.empty()       ? -1
                                          : character.joints.size() == 1 ? 0
                                                                         : 1});
  }
  character.positions.assign(3, vec3(0));
  character.first_weight = {0, 1, 2, 3};
  character.weights = {{1, 1}, {2, 1}, {3, 1}};
  ExpressionRig rig = make_expression_rig(default_expressions(), character);
  ExpressionSum sum;
  clear(sum, rig);
  Protected words{.closing = {1, 1}};
  words.visemes[size_t(Viseme::aa)] = 1;
  protect(sum, rig, words);
  Pose pose = make_rest_pose(character);
  apply_controls(sum, rig, pose);
  EXPECT_NEAR(2 * std::acos(pose.rotations[2].w), 0.66f, 1e-3f);
  EXPECT_GT(2 * std::acos(pose.rotations[3].w), 0.1f);
  EXPECT_EQ(pose.rotations[1], quat(1, 0, 0, 0));
}

TEST(Expressions, NestingMultipliesOutAndRotatorsFollowTheirRanges) {
  ExpressionSet set = read_expressions(R"({"format":"wellspring-expressions","version":1,
    "rotators":[{"name":"r","joint":"skullbase","weight_ranges":[-1,0,0.5,2],
                 "orientations":[[0,1,0,-0.4],[0,1,0,0],[0,1,0,0.1],[0,1,0,0.7]]}],
    "controls":[{"name":"c","displacers":["d"]}],
    "expressions":[
      {"name":"a","deform":[{"control":"c","weight":0.5}]},
      {"name":"t","rotate":[{"rotator":"r","weight":2}]},
      {"name":"b","group":[{"expression":"a","weight":0.5},{"expression":"t","weight":0.25}]},
      {"name":"c2","group":[{"expression":"b"},{"expression":"a","weight":0.2},{"expression":"t","weight":0.5}]}]})",
                                       "nested.json");
  Character character = with_displacers({"d"});
  character.joints[0].name = "skullbase";
  character.positions = {vec3(0)};
  character.first_weight = {0, 1};
  character.weights = {{0, 1}};
  ExpressionRig rig = make_expression_rig(set, character);
  ExpressionSum sum;
  clear(sum, rig);
  add(sum, rig, find_expression(set, "c2"), 0.8f);
  EXPECT_NEAR(sum.controls[0], 0.8f * (0.25f + 0.1f), 1e-6f);
  EXPECT_NEAR(sum.rotators[0], 0.8f * 1.5f, 1e-6f);
  auto yaw = [&](float weight) {
    vec3 ahead = eval_rotator(set.rotators[0], weight) * vec3(0, 0, 1);
    return std::atan2(ahead.x, ahead.z);
  };
  EXPECT_NEAR(yaw(-5), -0.4f, 1e-5f);
  EXPECT_NEAR(yaw(-0.5f), -0.2f, 1e-5f);
  EXPECT_NEAR(yaw(0.25f), 0.05f, 1e-5f);
  EXPECT_NEAR(yaw(1.25f), 0.4f, 1e-5f);
  EXPECT_NEAR(yaw(9), 0.7f, 1e-5f);
}

}  // namespace
}  // namespace wellspring::test
