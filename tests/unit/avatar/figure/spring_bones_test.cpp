// SPDX-License-Identifier: Apache-2.0
// Hair and cloth that swing: by their formula, at any tick rate, clear of the body.
#include "avatar/figure/spring_bones.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "avatar/figure/figure_check.h"
#include "avatar/load/character_load.h"
#include "avatar/mind/storyteller.h"
#include "base/rng.h"
#include "unit/avatar/figures.h"
#include "unit/avatar/load/gltf_person.h"

namespace wellspring::test {
namespace {

constexpr float length = 0.12f;

// A head with a braid of `count` bones that hangs down behind it.
Character make_braid(int count, SpringBone like) {
  Character character;
  character.joints.resize(1);
  character.joints[0].name = "skullbase";
  for (int i = 0; i < count; i++) {
    character.joints.push_back({.name = "braid" + std::to_string(i),
                                .parent = i,
                                .center = vec3(0, -length * float(i), -0.1f)});
    SpringBone bone = like;
    bone.joint = i + 1;
    bone.tail = vec3(0, -length, 0);
    character.springs.push_back(bone);
  }
  return character;
}

SpringBone make_bone(float stiffness, float drag) {
  return SpringBone{.stiffness = stiffness, .drag = drag};
}

// Angle by which the first bone of the braid lags behind a head that has leant over by `lean`.
float lag(const Pose& pose) { return 2 * std::asin(pose.rotations[1].x); }

Pose posed(const Character& character, float lean) {
  Pose pose = make_rest_pose(character);
  pose.rotations[0] = glm::angleAxis(lean, vec3(1, 0, 0));
  return pose;
}

// The bone's swing about its joint, which stays in place, after the head has leant over at once.
TEST(SpringBones, StepResponseIsItsFormulaAtAnyTickRate) {
  for (auto [stiffness, drag] : {std::pair(1.0f, 0.4f), {0.2f, 0.05f}, {0.5f, 0.9f}, {4.0f, 0.99f}})
    for (int rate : {7, 30, 60, 144}) {
      Character character = make_braid(1, make_bone(stiffness, drag));
      character.joints[1].center = vec3(0);  // no way of its own
      SpringBonesState state;
      Pose pose = posed(character, 0);
      tick_spring_bones(state, character, 0, pose);
      constexpr float lean = 0.5f;
      double square = 60 * double(stiffness) / double(length), c = -60 * std::log(1 - double(drag));
      double a = c / 2;
      std::complex<double> root = std::sqrt(std::complex<double>(a * a - square));
      for (int tick = 1; tick <= rate; tick++) {
        pose = posed(character, lean);
        tick_spring_bones(state, character, 1.0f / float(rate), pose);
        double t = double(tick) / rate;
        std::complex<double> formula =
            std::exp(-a * t) * (std::cosh(root * t) + a * std::sinh(root * t) / root);
        EXPECT_NEAR(double(lag(pose)), -double(lean) * formula.real(), 2e-4)
            << "stiffness " << stiffness << " drag " << drag << " rate " << rate << " tick "
            << tick;
      }
    }
}

// The format's own rule at the sixty steps a second that it is meant for.
TEST(SpringBones, SwingsAsTheFormatsRuleAtSixtySteps) {
  Character character = make_braid(1, make_bone(0.05f, 0.05f));
  character.springs[0].gravity = vec3(0, 0, -0.02f);
  SpringBonesState state;
  Pose pose = posed(character, 0);
  tick_spring_bones(state, character, 0, pose);
  vec3 pivot = character.joints[1].center;
  vec3 end = pivot + glm::normalize(vec3(0, -0.05f, -0.02f)) * length, before = end;
  for (int step = 0; step < 180; step++) {
    float lean = step < 60 ? 0.0f : 0.2f;
    pose = posed(character, lean);
    quat head = pose.rotations[0];
    vec3 place = head * pivot;
    vec3 next = end + (end - before) * (1 - 0.05f) +
                (head * vec3(0, -1, 0) * 0.05f + vec3(0, 0, -0.02f)) / 60.0f;
    next = place + glm::normalize(next - place) * length;
    before = end, end = next;
    tick_spring_bones(state, character, 1 / 60.0f, pose);
    vec3 ours = place + head * (pose.rotations[1] * vec3(0, -length, 0));
    EXPECT_LT(glm::length(ours - end), 0.10f * 0.2f * length + 0.001f) << step;
  }
}

TEST(SpringBones, ABraidOfAnyNumberOfBonesComesToRestWhereItIsDrawn) {
  SpringBone like = make_bone(0.3f, 0.3f);
  Character character = make_braid(6, like);
  SpringBonesState state;
  Pose pose = posed(character, 0);
  tick_spring_bones(state, character, 0, pose);
  float most = 0;
  for (int tick = 0; tick < 600; tick++) {
    pose = posed(character, tick < 30 ? 0.02f * float(tick) : 0.6f);
    tick_spring_bones(state, character, 1 / 60.0f, pose);
    most = std::max(most, std::abs(lag(pose)));
  }
  EXPECT_GT(most, 0.02f) << "it lags behind while the head moves";
  for (size_t j = 1; j < pose.rotations.size(); j++)
    EXPECT_NEAR(pose.rotations[j].w, 1, 1e-6f) << "rest is as modelled";
}

// Balls, capsules and planes are kept clear of, and what keeps inside keeps inside, at every tick.
TEST(SpringBones, MeetsColliders) {
  std::vector<SpringCollider> cases(4);
  cases[0].place = cases[0].tail = vec3(0, -0.10f, -0.16f), cases[0].radius = 0.05f;
  cases[1].place = vec3(-0.3f, -0.12f, -0.17f), cases[1].tail = vec3(0.3f, -0.12f, -0.17f),
  cases[1].radius = 0.03f;
  cases[2].place = cases[2].tail = vec3(0, 0, -0.15f), cases[2].normal = vec3(0, 0, 1);
  cases[3].place = cases[3].tail = vec3(0, -0.03f, -0.1f), cases[3].radius = 0.135f,
  cases[3].inside = true;
  for (size_t i = 0; i < cases.size(); i++) {
    SpringBone like = make_bone(0.4f, 0.2f);
    like.gravity = vec3(0, 0, -0.5f);  // a strong wind into it
    like.colliders = {0};
    like.radius = 0.01f;
    Character character = make_braid(1, like);
    character.spring_colliders = {cases[i]};
    SpringBonesState state;
    Rng rng{5};
    for (int tick = 0; tick < 400; tick++) {
      Pose pose = posed(character, 0.3f * std::sin(0.1f * float(tick)));
      quat head = pose.rotations[0];
      tick_spring_bones(state, character, 0.1f * rng.uniform(), pose);
      vec3 end = head * (character.joints[1].center + pose.rotations[1] * vec3(0, -length, 0));
      vec3 place = head * cases[i].place, along = head * cases[i].tail - place;
      if (dot(along, along) > 0)
        place += along * std::clamp(dot(end - place, along) / dot(along, along), 0.0f, 1.0f);
      float distance = glm::length(end - place);
      float kept = cases[i].normal != vec3(0) ? dot(end - place, head * cases[i].normal) - 0.01f
                   : cases[i].inside          ? cases[i].radius - 0.01f - distance
                                              : distance - cases[i].radius - 0.01f;
      EXPECT_GT(kept, i == 1 ? -1e-3f : -1e-5f) << i << " at " << tick;
    }
  }
}

TEST(SpringBones, AnyStepAndAnyNumbersAreSafe) {
  SpringBone like = make_bone(1, 0.4f);
  like.gravity = vec3(0, -0.2f, 0);
  Character character = make_braid(5, like);
  character.springs[1].stiffness = 0, character.springs[1].gravity = vec3(0),
  character.springs[1].drag = 1;
  character.springs[2].drag = 0;
  SpringBonesState state;
  Rng rng{7};
  for (int tick = 0; tick < 2000; tick++) {
    Pose pose = posed(character, 3 * rng.uniform());
    pose.translation = vec3(rng.uniform(), 0, 0) * (tick % 100 == 5 ? 1e6f : 1.0f);
    if (tick % 97 == 3) pose.translation.y = NAN;
    float dt = tick % 50 == 0   ? 1e6f
               : tick % 51 == 0 ? -1.0f
               : tick % 53 == 0 ? NAN
                                : 0.05f * rng.uniform();
    tick_spring_bones(state, character, dt, pose);
    for (size_t j = 1; j < pose.rotations.size(); j++)
      ASSERT_NEAR(glm::length(pose.rotations[j]), 1, 1e-4f) << tick;
  }
  // Steps without time leave it where it is.
  Pose first = posed(character, 0.2f);
  tick_spring_bones(state, character, 10, first);
  for (int i = 0; i < 5; i++) {
    Pose again = posed(character, 0.2f);
    tick_spring_bones(state, character, 0, again);
    for (size_t j = 1; j < 6; j++)
      EXPECT_GT(std::abs(dot(again.rotations[j], first.rotations[j])), 0.99999f);
  }
}

// The bone's end counts in the frame of its centre: who is carried along with it does not swing.
TEST(SpringBones, WithACentreOnlyMovementAgainstItCounts) {
  for (bool centred : {false, true}) {
    SpringBone like = make_bone(0.5f, 0.3f);
    like.center = centred ? 0 : -1;
    Character character = make_braid(1, like);
    SpringBonesState state;
    float most = 0;
    for (int tick = 0; tick < 60; tick++) {
      Pose pose = make_rest_pose(character);
      pose.translation.x = 0.03f * float(tick);
      tick_spring_bones(state, character, 1 / 60.0f, pose);
      most = std::max(most, 2 * std::acos(std::min(pose.rotations[1].w, 1.0f)));
    }
    EXPECT_EQ(most > 0.05f, !centred) << most;
    if (centred) {
      EXPECT_LT(most, 1e-3f);
    }
  }
}

// Two bones of hair behind the head, the second without an end.
void add_hair(Asset& asset) {
  json& nodes = asset.root["nodes"];
  size_t first = nodes.size();
  nodes.push_back({{"name", "Hair1"}, {"translation", {0, 0.2, -0.1}}, {"children", {first + 1}}});
  nodes.push_back({{"name", "Hair2"}, {"translation", {0, -0.1, 0}}});
  nodes[size_t(test::person_bone("head"))]["children"].push_back(first);
}

Character figure_of(const Asset& asset) {
  TempFolder folder;
  return load_character(folder.write("person.vrm", asset.glb()));
}

TEST(SpringBones, OfVersion1AreRead) {
  Asset asset = test::make_person();
  test::add_vrm_1(asset);
  add_hair(asset);
  size_t hair = asset.root["nodes"].size() - 2, head = size_t(test::person_bone("head"));
  asset.root["extensionsUsed"].push_back("VRMC_springBone");
  asset.root["extensions"]["VRMC_springBone"] = {
      {"specVersion", "1.0"},
      {"colliders",
       {{{"node", head}, {"shape", {{"sphere", {{"offset", {0, 0.1, 0}}, {"radius", 0.09}}}}}},
        {{"node", head},
         {"shape",
          {{"capsule", {{"offset", {0, 0, 0}}, {"tail", {0, 0.1, 0}}, {"radius", 0.05}}}}}}}},
      {"colliderGroups", {{{"colliders", {0, 1}}}}},
      {"springs",
       {{{"colliderGroups", {0}},
         {"center", head},
         {"joints",
          {{{"node", hair},
            {"stiffness", 0.7},
            {"dragForce", 0.3},
            {"hitRadius", 0.02},
            {"gravityPower", 0.5},
            {"gravityDir", {0, -1, 0}}},
           {{"node", hair + 1}}}}}}}};
  Character character = figure_of(asset);
  ASSERT_EQ(character.springs.size(), 1u) << "the last joint is the end of the one before";
  const SpringBone& bone = character.springs[0];
  EXPECT_EQ(character.joints[size_t(bone.joint)].name, "Hair1");
  EXPECT_LT(glm::length(bone.tail - vec3(0, -0.1f, 0)), 1e-5f);
  EXPECT_LT(glm::length(bone.gravity - vec3(0, -0.5f, 0)), 1e-5f);
  EXPECT_FLOAT_EQ(bone.stiffness, 0.7f);
  EXPECT_FLOAT_EQ(bone.drag, 0.3f);
  EXPECT_NEAR(bone.radius, 0.02f, 1e-6f);
  EXPECT_EQ(character.joints[size_t(bone.center)].name, "skullbase");
  EXPECT_EQ(bone.colliders, (std::vector<int>{0, 1}));
  ASSERT_EQ(character.spring_colliders.size(), 2u);
  EXPECT_LT(glm::length(character.spring_colliders[0].place - vec3(0, 1.62f, 0)), 1e-4f);
  EXPECT_LT(glm::length(character.spring_colliders[1].tail - vec3(0, 1.62f, 0)), 1e-4f);

  EXPECT_NE(describe_text(character).find("1 joints swing, 2 colliders"), std::string::npos);

  asset.root["extensions"]["VRMC_springBone"]["colliderGroups"][0]["colliders"][0] = 7;
  EXPECT_THROW(figure_of(asset), std::runtime_error);
}

TEST(SpringBones, OfVersion0AreReadAndFaceTheOtherWay) {
  test::PersonOptions options;
  options.world = quat(0, 0, 1, 0);  // version 0 faces -Z, with the axes of bones along the world's
  options.axes = quat(0, 0, -1, 0);
  Asset asset = test::make_person(options);
  test::add_vrm_0(asset);
  add_hair(asset);
  size_t hair = asset.root["nodes"].size() - 2, head = size_t(test::person_bone("head"));
  asset.root["extensions"]["VRM"]["secondaryAnimation"] = {
      {"boneGroups",
       {{{"stiffiness", 0.6},
         {"gravityPower", 0.1},
         {"gravityDir", {{"x", 0}, {"y", 0}, {"z", -1}}},
         {"dragForce", 0.2},
         {"hitRadius", 0.03},
         {"center", -1},
         {"bones", {hair, head}},
         {"colliderGroups", {0}}}}},
      {"colliderGroups",
       {{{"node", head},
         {"colliders", {{{"offset", {{"x", 0}, {"y", 0}, {"z", 0.05}}}, {"radius", 0.08}}}}}}}};
  Character character = figure_of(asset);
  ASSERT_EQ(character.springs.size(), 2u) << "all that hangs below, but no bone of the body";
  EXPECT_EQ(character.joints[size_t(character.springs[1].joint)].name, "Hair2");
  EXPECT_NEAR(glm::length(character.springs[1].tail), 0.07f, 1e-5f);
  EXPECT_FLOAT_EQ(character.springs[0].stiffness, 0.6f);
  EXPECT_LT(glm::length(character.springs[0].gravity - vec3(0, 0, 0.1f)), 1e-5f)
      << "turned with the figure";
  ASSERT_EQ(character.spring_colliders.size(), 1u);
  // The offset's z is left-handed in the file: -0.05 along the world's axes, and the head looks
  // there.
  EXPECT_LT(glm::length(character.spring_colliders[0].place - vec3(0, 1.52f, 0.05f)), 1e-4f);
  bool said = false;
  for (const std::string& warning : character.warnings)
    said = said || warning.find("a bone of the body does not swing") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST(SpringBones, SwingOnlyWhereSomebodyIsNearEnoughToSee) {
  Asset asset = test::make_person();
  test::add_vrm_1(asset);
  add_hair(asset);
  size_t hair = asset.root["nodes"].size() - 2;
  asset.root["extensionsUsed"].push_back("VRMC_springBone");
  asset.root["extensions"]["VRMC_springBone"]["springs"] = {
      {{"joints", {{{"node", hair}, {"stiffness", 0.2}}, {{"node", hair + 1}}}}}};
  Character character = figure_of(asset);
  ASSERT_EQ(character.springs.size(), 1u);
  Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  size_t joint = size_t(character.springs[0].joint);
  auto run = [&](float distance, int ticks) {
    float most = 0;
    input.viewer_distance = distance;
    for (int i = 0; i < ticks; i++) {
      input.dt = 1 / 30.0f;
      tick_storyteller(state, storyteller, input, pose, events);
      most = std::max(most, 1 - std::abs(pose.rotations[joint].w));
    }
    return most;
  };
  EXPECT_GT(run(2, 300), 0) << "idling moves the head, and the hair follows late";
  EXPECT_EQ(state.work.springs, 300u);
  EXPECT_EQ(run(20, 300), 0);
  EXPECT_EQ(state.work.springs, 300u);
  run(5, 10);
  EXPECT_EQ(state.work.springs, 310u);
}

}  // namespace
}  // namespace wellspring::test
