// SPDX-License-Identifier: Apache-2.0
// Constraints between joints against the formulas of VRMC_node_constraint-1.0, which are about
// nodes with axes of their own: the file's nodes are followed here as the format does it.
#include "avatar/figure/joint_constraints.h"

#include <gtest/gtest.h>

#include <functional>

#include "avatar/body/body.h"
#include "avatar/figure/figure_check.h"
#include "avatar/load/character_load.h"
#include "avatar/mind/storyteller.h"
#include "base/load_error.h"
#include "base/rng.h"
#include "unit/avatar/figures.h"
#include "unit/avatar/load/gltf_person.h"

namespace wellspring::test {
namespace {

using test::add_vrm_0;
using test::add_vrm_1;
using test::PersonOptions;
using Kind = JointConstraint::Kind;

struct Asked {
  const char *kind, *axis;
  size_t source;
  double weight;
};

quat random_turn(Rng& rng) {
  auto half = [&] { return rng.uniform() - 0.5f; };
  quat q(half(), half(), half(), half());
  return glm::length(q) > 0.05f ? glm::normalize(q) : quat(1, 0, 0, 0);
}

// A node with a turn of its own below another; returns its index.
size_t add_node(Asset& asset, size_t parent, vec3 place, quat q, const char* name) {
  size_t node = asset.root["nodes"].size();
  asset.root["nodes"].push_back({{"name", name},
                                 {"translation", {place.x, place.y, place.z}},
                                 {"rotation", {q.x, q.y, q.z, q.w}}});
  asset.root["nodes"][parent]["children"].push_back(node);
  return node;
}

void constrain(Asset& asset, size_t node, const Asked& asked) {
  json one = {{"source", asked.source}, {"weight", asked.weight}};
  if (std::string(asked.kind) == "roll") one["rollAxis"] = asked.axis;
  if (std::string(asked.kind) == "aim") one["aimAxis"] = asked.axis;
  asset.root["extensionsUsed"].push_back("VRMC_node_constraint");
  asset.root["nodes"][node]["extensions"]["VRMC_node_constraint"] = {
      {"specVersion", "1.0"}, {"constraint", {{asked.kind, one}}}};
}

// The file's nodes, as the format sees them.
struct Nodes {
  std::vector<int> parent;
  std::vector<vec3> place;
  std::vector<quat> rest, now;

  explicit Nodes(const json& root) : parent(root["nodes"].size(), -1) {
    for (size_t i = 0; i < parent.size(); i++) {
      const json& node = root["nodes"][i];
      json r = node.value("rotation", json{0, 0, 0, 1}),
           t = node.value("translation", json{0, 0, 0});
      auto number = [](const json& v, size_t k) { return v[k].get<float>(); };
      rest.push_back(quat(number(r, 3), number(r, 0), number(r, 1), number(r, 2)));
      place.push_back({number(t, 0), number(t, 1), number(t, 2)});
      for (const json& child : node.value("children", json::array()))
        parent[child.get<size_t>()] = int(i);
    }
    now = rest;
  }
  quat turn(int i, const std::vector<quat>& local) const {
    return i < 0 ? quat(1, 0, 0, 0) : turn(parent[size_t(i)], local) * local[size_t(i)];
  }
  vec3 position(int i) const {
    return i < 0 ? vec3(0)
                 : position(parent[size_t(i)]) + turn(parent[size_t(i)], now) * place[size_t(i)];
  }
};

quat from_to(vec3 a, vec3 b) {
  return dot(a, b) < -0.9999f ? glm::angleAxis(pi, normalize(cross(a, vec3(0.3f, 0.5f, -0.8f))))
                              : glm::normalize(quat(1 + dot(a, b), cross(a, b)));
}

// The pseudocode of the specification, word for word.
quat by_the_format(const Nodes& nodes, size_t node, const Asked& asked, vec3 axis) {
  quat src_rest = nodes.rest[asked.source], src = nodes.now[asked.source],
       dst_rest = nodes.rest[node];
  quat delta = glm::inverse(src_rest) * src, target;
  if (std::string(asked.kind) == "rotation") {
    target = dst_rest * delta;
  } else if (std::string(asked.kind) == "roll") {
    quat in_parent = src_rest * delta * glm::inverse(src_rest);
    quat in_dst = glm::inverse(dst_rest) * in_parent * dst_rest;
    target = dst_rest * glm::inverse(from_to(axis, normalize(in_dst * axis))) * in_dst;
  } else {
    quat above = nodes.turn(nodes.parent[node], nodes.now);
    vec3 way = normalize(nodes.position(int(asked.source)) - nodes.position(int(node)));
    target = glm::inverse(above) * from_to(above * dst_rest * axis, way) * above * dst_rest;
  }
  return glm::slerp(dst_rest, target, float(asked.weight));
}

// The joint of each node that is a bone, found by its place; -1: none.
std::vector<int> joints_of_nodes(const Nodes& nodes, const Character& character, quat world) {
  std::vector<int> joint_of(nodes.parent.size(), -1);
  const auto& bones = test::person_bones();
  for (size_t i = 0; i < bones.size(); i++)
    for (size_t j = 0; j < character.joints.size(); j++)
      if (glm::length(world * character.joints[j].center - world * vec3(0) -
                      world * bones[i].place) < 1e-4f)
        joint_of[i] = int(j);
  return joint_of;
}

// A node between the bone `upper` and another one below it that will be constrained.
struct ExtraNodes {
  size_t between, twist;
};
ExtraNodes add_extra_nodes(Asset& asset, size_t upper, Rng& rng) {
  size_t between = add_node(asset, upper, {0.1f, 0.02f, 0}, random_turn(rng), "between");
  return {between, add_node(asset, between, {0.05f, 0.1f, 0.03f}, random_turn(rng), "twist")};
}

TEST(JointConstraints, AreThoseOfTheFormatWhateverTheAxesOfTheNodes) {
  struct Case {
    Asked asked;
    vec3 axis;
  };
  size_t arm = size_t(person_bone("leftLowerArm")), hand = size_t(person_bone("leftHand")),
         upper = size_t(person_bone("leftUpperArm")), foot = size_t(person_bone("rightFoot"));
  const Case cases[] = {{{"roll", "X", arm, 0.5}, {1, 0, 0}},
                        {{"roll", "Y", hand, 1}, {0, 1, 0}},
                        {{"roll", "Z", foot, 0.25}, {0, 0, 1}},
                        {{"rotation", "", upper, 1}, {}},
                        {{"rotation", "", foot, 0.3}, {}},
                        {{"aim", "PositiveX", hand, 1}, {1, 0, 0}},
                        {{"aim", "NegativeY", foot, 0.6}, {0, -1, 0}},
                        {{"aim", "PositiveZ", arm, 0.4}, {0, 0, 1}},
                        {{"aim", "NegativeZ", arm, 1}, {0, 0, -1}}};
  Rng rng{11};
  int seen = 0;
  for (bool version_0 : {false, true})
    for (const Case& c : cases) {
      PersonOptions options{.axes = glm::angleAxis(1.0f, normalize(vec3(1, 2, 3))),
                            .odd_axes = true};
      if (version_0) options.world = quat(0, 0, 1, 0);
      Asset asset = make_person(options);
      version_0 ? add_vrm_0(asset) : add_vrm_1(asset);
      const auto [between, twist] = add_extra_nodes(asset, upper, rng);
      constrain(asset, twist, c.asked);
      Character character = load_asset(asset);
      ASSERT_EQ(character.constraints.size(), 1u);
      const JointConstraint& constraint = character.constraints[0];
      EXPECT_EQ(character.joints[size_t(constraint.joint)].name, "twist");
      Nodes nodes(asset.root);
      Pose pose = make_rest_pose(character);
      std::vector<int> joint_of = joints_of_nodes(nodes, character, options.world);
      joint_of[between] = find_joint(character, "between"), joint_of[twist] = constraint.joint;
      std::vector<quat> rest_turn;  // each node's, in humanoid space
      for (size_t i = 0; i < joint_of.size(); i++)
        rest_turn.push_back(glm::conjugate(options.world) * nodes.turn(int(i), nodes.rest));
      auto above = [&](size_t i) {
        return nodes.parent[i] < 0 ? glm::conjugate(options.world)
                                   : rest_turn[size_t(nodes.parent[i])];
      };
      for (int round = 0; round < 40; round++) {
        for (size_t i = 0; i < joint_of.size(); i++) {
          if (joint_of[i] < 0 || i == twist) continue;
          quat turn = random_turn(rng);
          pose.rotations[size_t(joint_of[i])] = turn;
          nodes.now[i] = glm::normalize(glm::conjugate(above(i)) * turn * rest_turn[i]);
        }
        nodes.now[twist] = by_the_format(nodes, twist, c.asked, c.axis);
        quat wanted = above(twist) * nodes.now[twist] * glm::conjugate(rest_turn[twist]);
        quat made = eval_constraint(character, constraint, pose);
        EXPECT_GT(std::abs(glm::dot(wanted, made)), 1 - 2e-5f)
            << c.asked.kind << " " << c.asked.axis << " " << round << (version_0 ? " 0.x" : " 1.0");
        seen++;
      }
    }
  EXPECT_EQ(seen, 2 * 9 * 40);
}

TEST(JointConstraints, AtRestNothingTurns) {
  PersonOptions options{.odd_axes = true};
  Asset asset = make_person(options);
  add_vrm_1(asset);
  size_t arm = size_t(person_bone("leftLowerArm"));
  constrain(asset, add_node(asset, arm, {0.1f, 0, 0}, quat(0.6f, 0, 0.8f, 0), "one"),
            {"roll", "Z", arm, 0.7});
  constrain(asset, add_node(asset, 0, {0.1f, 0, 0}, quat(0.8f, 0.6f, 0, 0), "two"),
            {"rotation", "", arm, 1});
  Character character = load_asset(asset);
  ASSERT_EQ(character.constraints.size(), 2u);
  Pose pose = make_rest_pose(character);
  follow_constraints(character, pose);
  for (quat q : pose.rotations) EXPECT_NEAR(std::abs(q.w), 1, 1e-6f);
}

// Whatever their order in the file; and what cannot be ordered is told by name, while the rest
// works.
TEST(JointConstraints, AreFollowedInTheOrderOfWhatTheyDependOn) {
  size_t arm = size_t(person_bone("leftLowerArm"));
  Asset asset = make_person();
  add_vrm_1(asset);
  // Each takes the turn of the next; the last one that of the arm.
  std::vector<size_t> chain;
  for (int i = 0; i < 5; i++)
    chain.push_back(
        add_node(asset, 0, {0.1f, 0, 0}, quat(1, 0, 0, 0), ("link" + std::to_string(i)).c_str()));
  for (size_t i = 0; i < 5; i++)
    constrain(asset, chain[i], {"rotation", "", i < 4 ? chain[i + 1] : arm, 1});
  Character character = load_asset(asset);
  ASSERT_EQ(character.constraints.size(), 5u);
  Pose pose = make_rest_pose(character);
  quat turn = glm::angleAxis(0.8f, normalize(vec3(1, 2, -1)));
  pose.rotations[size_t(find_joint(character, "l_elbow"))] = turn;
  follow_constraints(character, pose);
  EXPECT_NEAR(std::abs(glm::dot(pose.rotations[size_t(find_joint(character, "link0"))], turn)), 1,
              1e-5f);

  EXPECT_NE(describe_text(character).find("constraints  5 joints follow others"),
            std::string::npos);
  auto told = nlohmann::json::parse(describe_json(character))["constraints"];
  ASSERT_EQ(told.size(), 5u);
  EXPECT_EQ(told[0]["joint"], "link4") << "in the order they are followed";
  EXPECT_EQ(told[0]["source"], "l_elbow");
  EXPECT_EQ(told[0]["kind"], "rotation");

  constrain(asset, chain[4], {"rotation", "", chain[2], 1});  // 2, 3, 4 in a circle
  constrain(asset, add_node(asset, 0, {0, 0, 0}, quat(1, 0, 0, 0), "narcissus"),
            {"rotation", "", 23, 1});
  constrain(asset, add_node(asset, 0, {0, 0, 0}, quat(1, 0, 0, 0), "good"),
            {"rotation", "", arm, 1});
  size_t tail = add_node(asset, chain[0], {0, 0.1f, 0}, quat(1, 0, 0, 0), "tail");
  size_t dog = add_node(asset, tail, {0, 0.1f, 0}, quat(1, 0, 0, 0), "dog");
  constrain(asset, tail, {"aim", "PositiveY", dog, 1});  // its target turns with it
  character = load_asset(asset);
  EXPECT_TRUE(says(character, "in a circle are not followed: "));
  for (const char* name : {"link2", "link3", "link4", "narcissus", "tail"}) {
    EXPECT_TRUE(says(character, name)) << name;
    for (const JointConstraint& constraint : character.constraints)
      EXPECT_NE(character.joints[size_t(constraint.joint)].name, name);
  }
  ASSERT_EQ(character.constraints.size(), 1u) << "links 0 and 1 wait for a circle, too";
  pose = make_rest_pose(character);
  pose.rotations[size_t(find_joint(character, "l_elbow"))] = turn;
  follow_constraints(character, pose);
  EXPECT_NEAR(std::abs(glm::dot(pose.rotations[size_t(find_joint(character, "good"))], turn)), 1,
              1e-5f);
}

TEST(JointConstraints, TheStorytellersTwistBonesFollowItsArms) {
  size_t arm = size_t(person_bone("leftUpperArm"));
  Asset asset = make_person();
  add_vrm_1(asset);
  constrain(asset, add_node(asset, 2, {0.1f, 0, 0}, quat(1, 0, 0, 0), "twin"),
            {"rotation", "", arm, 1});
  Character character = load_asset(asset);
  Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  for (int i = 0; i < 5; i++) {
    input.dt = 0.1f;
    input.time += 0.1;
    tick_storyteller(state, storyteller, input, pose, events);
  }
  quat wanted = pose.rotations[size_t(find_joint(character, "l_shoulder"))];
  EXPECT_LT(std::abs(wanted.w), 0.95f) << "the arm hangs down from its T-pose";
  EXPECT_NEAR(std::abs(glm::dot(pose.rotations[size_t(find_joint(character, "twin"))], wanted)), 1,
              1e-5f);
}

TEST(JointConstraints, BadOnesAreRefusedWithTheirPlaceAndBadPosesAreSafe) {
  size_t arm = size_t(person_bone("leftUpperArm"));
  auto refusal = [&](const char* pointer, const json& value) {
    Asset asset = make_person();
    size_t node = add_node(asset, 2, {0.1f, 0, 0}, quat(1, 0, 0, 0), "twin");
    constrain(asset, node, {"aim", "PositiveX", arm, 1});
    asset.root["nodes"][node]["extensions"]["VRMC_node_constraint"][json::json_pointer(pointer)] =
        value;
    try {
      Character c = load_asset(asset);
      return says(c, "not one of roll, aim and rotation") ? std::string("told")
                                                          : std::string("loads");
    } catch (const LoadError& error) {
      return error.where + ": " + error.what_;
    }
  };
  EXPECT_NE(refusal("/constraint/aim/aimAxis", "X").find("constraint/aim/aimAxis: 'X' is no axis"),
            std::string::npos);
  EXPECT_NE(refusal("/constraint/aim/source", 99).find("aim/source"), std::string::npos);
  EXPECT_NE(refusal("/constraint/aim/source", -1).find("has no source"), std::string::npos);
  EXPECT_NE(refusal("/constraint/aim", 3).find("must be an object"), std::string::npos);
  EXPECT_NE(refusal("/constraint", json::array()).find("must be an object"), std::string::npos);
  EXPECT_EQ(refusal("/constraint/roll", json::object()), "told");
  EXPECT_EQ(refusal("/constraint/aim/weight", 7), "loads");

  Character character;
  character.joints.resize(3);
  character.joints[1].parent = character.joints[2].parent = 0;
  character.constraints = {{1, 2, Kind::roll, 1, vec3(0, 1, 0), {}},
                           {1, 2, Kind::aim, 1, vec3(0, 1, 0), {}}};
  Pose pose = make_rest_pose(character);
  for (quat bad : {quat(0, 0, 0, 0), quat(NAN, 0, 0, 0), quat(1e30f, 0, 0, 0), quat(0, 1, 0, 0),
                   quat(0, 0, 0, -1)}) {
    pose.rotations[2] = bad;
    for (const JointConstraint& constraint : character.constraints)
      EXPECT_NEAR(glm::length(eval_constraint(character, constraint, pose)), 1, 1e-5f);
  }
}

}  // namespace
}  // namespace wellspring::test
