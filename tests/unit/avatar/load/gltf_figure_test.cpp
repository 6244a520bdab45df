// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "avatar/body/body.h"
#include "avatar/figure/rig.h"
#include "avatar/figure/skin.h"
#include "base/load_error.h"
#include "unit/avatar/figures.h"
#include "unit/avatar/load/gltf_person.h"

namespace wellspring::test {
namespace {

using test::add_vrm_0;
using test::add_vrm_1;
using test::PersonOptions;

vec3 centre(const Character& c, const char* joint) {
  int j = find_joint(c, joint);
  EXPECT_GE(j, 0) << joint;
  return j < 0 ? vec3(NAN) : c.joints[size_t(j)].center;
}

std::vector<vec3> posed(const Character& c, const Pose& pose) {
  SkinScratch scratch;
  std::vector<vec3> positions, normals;
  skin(c, pose, mat4(1), scratch, positions, normals);
  return positions;
}

void expect_same_places(const std::vector<vec3>& a, const std::vector<vec3>& b,
                        float tolerance = 2e-5f) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t v = 0; v < a.size(); v++) ASSERT_LT(glm::length(a[v] - b[v]), tolerance) << v;
}

TEST(GltfFigure, BonesOfVrmAreJointsOfHAnim) {
  Asset asset = make_person();
  add_vrm_1(asset);
  Character c = load_asset(asset);
  EXPECT_EQ(c.name, "Ada");
  EXPECT_EQ(c.joints.size(), 17u);
  EXPECT_NEAR(centre(c, "l_elbow").x, 0.45f, 1e-5f);
  EXPECT_NEAR(centre(c, "skullbase").y, 1.52f, 1e-5f);
  EXPECT_EQ(c.joints[size_t(find_joint(c, "r_radiocarpal"))].parent, find_joint(c, "r_elbow"));
  EXPECT_NEAR(c.eye_ranges.inner.most, pi / 2, 1e-5f);
  EXPECT_NEAR(c.eye_ranges.inner.output, 9 * pi / 180, 1e-5f);
  ASSERT_FALSE(c.metadata.empty());
  EXPECT_EQ(c.metadata[0], std::pair(std::string("authors"), std::string("A. Author, B. Author")));
  int aa = find_displacer(c, "aa"), raw = find_displacer(c, "MouthOpen");
  ASSERT_GE(aa, 0);
  ASSERT_GE(raw, 0);
  EXPECT_NEAR(c.displacers[size_t(raw)].displacements[0].y, -0.02f, 1e-6f);
  EXPECT_NEAR(c.displacers[size_t(aa)].displacements[0].y, -0.01f, 1e-6f);
  Rig rig = make_rig(c);
  EXPECT_GE(rig.viseme[10], 0) << "it can say a";
  EXPECT_TRUE(rig.leg[0].complete());
}

TEST(GltfFigure, CamerasAndLightsAreCountedAsLeftOut) {
  Asset asset = make_person();
  EXPECT_FALSE(says(load_asset(asset), "left out, as a figure has none"));
  const json camera = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}};
  asset.root["cameras"] = {camera, camera};
  asset.root["extensionsUsed"] = {"KHR_lights_punctual"};
  asset.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  Character c = load_asset(asset);
  EXPECT_TRUE(says(c, "left out, as a figure has none: 2 camera(s)"));
  EXPECT_TRUE(says(c, "left out, as a figure has none: 1 light(s)"));
}

// Counts the figure's triangles whose winding agrees with their normals, and those whose winding
// does not.
std::pair<int, int> outward_and_inward(const Character& c) {
  std::pair<int, int> count(0, 0);
  for (const Part& part : c.parts)
    for (const uvec3& t : part.triangles) {
      const vec3 face =
          cross(c.positions[t.y] - c.positions[t.x], c.positions[t.z] - c.positions[t.x]);
      const vec3 normal = c.normals[t.x] + c.normals[t.y] + c.normals[t.z];
      (dot(face, normal) > 0 ? count.first : count.second)++;
    }
  return count;
}

TEST(GltfFigure, TheNodeOfASkinnedMeshDecidesWhichSideIsItsFront) {
  Asset asset = make_person();
  add_vrm_1(asset);
  const auto plain = outward_and_inward(load_asset(asset));
  ASSERT_NE(plain.first, plain.second);
  asset.root["nodes"][17]["scale"] = {1, -1, 1};  // the joints stand as they did
  const auto mirrored = outward_and_inward(load_asset(asset));
  EXPECT_EQ(mirrored.first, plain.second);
  EXPECT_EQ(mirrored.second, plain.first);
}

TEST(GltfFigure, Vrm0FacesTheOtherWayAndIsTurned) {
  PersonOptions options{.world = quat(0, 0, 1, 0)};
  Asset asset = make_person(options);
  add_vrm_0(asset);
  Character c = load_asset(asset);
  expect_same_places(c.positions, load_asset(make_person()).positions);
  EXPECT_GT(centre(c, "l_shoulder").x, 0.1f);
  EXPECT_GE(find_displacer(c, "viseme_aa"), 0);
  EXPECT_TRUE(says(c, "a bone of the body does not swing"));
  EXPECT_TRUE(c.springs.empty());
}

TEST(GltfFigure, HowTheFileTurnsItsBonesDoesNotShow) {
  Character plain = load_asset(make_person());
  PersonOptions odd{.axes = glm::angleAxis(1.0f, normalize(vec3(1, 2, 3))), .odd_axes = true};
  Character turned = load_asset(make_person(odd));
  odd.world = glm::angleAxis(-pi / 2, vec3(1, 0, 0)) * glm::angleAxis(pi / 2, vec3(0, 1, 0));
  odd.unit = 100;
  Character lying = load_asset(make_person(odd));
  EXPECT_TRUE(says(lying, "turned to stand upright"));
  EXPECT_TRUE(says(lying, "centimetre"));
  Pose pose = make_rest_pose(plain);
  for (size_t j = 0; j < pose.rotations.size(); j++)
    pose.rotations[j] = glm::angleAxis(0.3f + 0.1f * float(j), normalize(vec3(1, float(j % 4), 2)));
  pose.displacers[0] = 0.7f;
  for (const Character* c : {&turned, &lying}) {
    ASSERT_EQ(c->joints.size(), plain.joints.size());
    for (size_t j = 0; j < c->joints.size(); j++)
      EXPECT_EQ(c->joints[j].name, plain.joints[j].name);
    expect_same_places(c->positions, plain.positions);
    expect_same_places(posed(*c, pose), posed(plain, pose), 5e-5f);
  }
}

TEST(GltfFigure, AFileThatPosesItsBonesRestsAsItWasBound) {
  PersonOptions options{.odd_axes = true};
  options.posed["leftUpperArm"] = glm::angleAxis(-1.0f, vec3(0, 0, 1));
  options.posed["rightLowerLeg"] = glm::angleAxis(0.6f, vec3(1, 0, 0));
  Character c = load_asset(make_person(options)), plain = load_asset(make_person());
  EXPECT_TRUE(says(c, "poses the figure"));
  expect_same_places(c.positions, plain.positions, 1e-4f);
  Pose pose = make_rest_pose(c);
  for (size_t j = 0; j < c.joints.size(); j++) pose.rotations[j] = c.joints[j].rest_rotation;
  Pose wanted = make_rest_pose(plain);
  wanted.rotations[size_t(find_joint(plain, "l_shoulder"))] = options.posed["leftUpperArm"];
  wanted.rotations[size_t(find_joint(plain, "r_knee"))] = options.posed["rightLowerLeg"];
  expect_same_places(posed(c, pose), posed(plain, wanted), 1e-4f);
}

TEST(GltfFigure, NamesOfOtherRigsAndNoNamesAtAll) {
  PersonOptions options{.names = {{"hips", "pelvis"},
                                  {"leftUpperArm", "upperarm_l"},
                                  {"leftLowerArm", "lowerarm_l"},
                                  {"leftHand", "hand_l"},
                                  {"head", "Antenna"}}};
  Character c = load_asset(make_person(options), false);
  EXPECT_NEAR(centre(c, "l_radiocarpal").x, 0.7f, 1e-5f);
  EXPECT_GE(find_joint(c, "Antenna"), 0);
  EXPECT_TRUE(says(c, "1 bone is no joint of H-Anim: Antenna"));
  options.named = false;
  Character nameless = load_asset(make_person(options));
  EXPECT_TRUE(says(nameless, "joints by their place"));
  EXPECT_NEAR(centre(nameless, "l_knee").y, 0.5f, 1e-5f);
}

// Eyes without joints look by shapes; eyes with joints only as far as the author lets them.
TEST(GltfFigure, EyesLookAsTheirAuthorDrewThem) {
  Asset asset = make_person();
  add_vrm_1(asset);
  auto& presets = asset.root["extensions"]["VRMC_vrm"]["expressions"]["preset"];
  for (const char* appearance : {"lookUp", "lookDown", "lookLeft", "lookRight"})
    presets[appearance] = presets["aa"];
  Character c = load_asset(asset);
  Rig rig = make_rig(c);
  ASSERT_FALSE(rig.eyes_move);
  for (int appearance : rig.look) ASSERT_GE(appearance, 0);
  Pose pose = make_rest_pose(c);
  aim_eyes(rig, rig.eyes_center + vec3(1, 0, 4), pose);  // to its own left
  EXPECT_NEAR(pose.displacers[size_t(rig.look[2])], std::atan(0.25f) / eye_limit_yaw, 1e-3f);
  EXPECT_EQ(pose.displacers[size_t(rig.look[3])], 0);
  aim_eyes(rig, rig.eyes_center + vec3(-100, -1000, 0.1f), pose);
  EXPECT_EQ(pose.displacers[size_t(rig.look[2])], 0);
  EXPECT_EQ(pose.displacers[size_t(rig.look[1])], 1);

  Character eyed = test::load_text(test::whole_figure());
  Rig eyed_rig = make_rig(eyed);
  ASSERT_TRUE(eyed_rig.eyes_move);
  auto turn_of = [&](int side) {
    Pose appearance = make_rest_pose(eyed);
    aim_eyes(eyed_rig, eyed_rig.eyes_center + vec3(100, 0, 300), appearance);
    return glm::angle(appearance.rotations[size_t(eyed_rig.eye[size_t(side)])]);
  };
  float left = turn_of(0), right = turn_of(1);
  EXPECT_GT(left, 0.2f);
  eyed.eye_ranges.outer = {1, 0.5f}, eyed.eye_ranges.inner = {1, 0.25f};
  EXPECT_NEAR(turn_of(0), 0.5f * left, 1e-3f) << "outwards";
  EXPECT_NEAR(turn_of(1), 0.25f * right, 1e-3f) << "inwards";
  eyed.eye_ranges.outer = {0.1f, 0.05f};
  EXPECT_NEAR(turn_of(0), 0.05f, 1e-5f) << "no further than that";
}

std::string refusal(const Asset& asset) {
  try {
    load_asset(asset);
  } catch (const LoadError& error) {
    EXPECT_FALSE(error.file.empty());
    return error.where + ": " + error.what_;
  }
  return "";
}

TEST(GltfFigure, BadSkinsAreRefusedWithTheirPlace) {
  auto change = [](int accessor, auto value, size_t element) {
    Asset asset = make_person();
    size_t view = asset.root["accessors"][size_t(accessor)]["bufferView"].get<size_t>();
    size_t offset = asset.root["bufferViews"][view]["byteOffset"].get<size_t>();
    std::memcpy(asset.bytes.data() + offset + element * sizeof value, &value, sizeof value);
    return asset;
  };
  Asset person = make_person();
  const json attributes = person.root["meshes"][0]["primitives"][0]["attributes"];
  int weights = attributes["WEIGHTS_0"].get<int>(), joints = attributes["JOINTS_0"].get<int>();
  int binds = person.root["skins"][0]["inverseBindMatrices"].get<int>();
  EXPECT_NE(refusal(change(weights, NAN, 4 * 9)).find("/meshes/0/primitives/0: vertex 9"),
            std::string::npos);
  EXPECT_NE(refusal(change(joints, uint16_t(17), 4 * 9)).find("joint 17 of 17"), std::string::npos);
  EXPECT_NE(refusal(change(binds, NAN, 16 * 2)).find("/skins/0/inverseBindMatrices: matrix 2"),
            std::string::npos);
  Asset cycle = make_person();
  cycle.root["nodes"][4]["children"] = {2};
  EXPECT_NE(refusal(cycle).find("/nodes/"), std::string::npos);
  Asset many = make_person();
  for (int i = 0; i < 5000; i++) {
    many.root["nodes"].push_back(json::object());
    many.root["skins"][0]["joints"].push_back(18 + i);
    if (i == 0) {
      EXPECT_NE(refusal(many).find("17 matrices for 18 joints"), std::string::npos);
    }
  }
  EXPECT_NE(refusal(many).find("more than 4096 joints"), std::string::npos);
  Asset chain = make_person();  // as deep as it is long
  for (int i = 0; i < 200'000; i++) chain.root["nodes"].push_back({{"children", {19 + i}}});
  chain.root["nodes"].push_back(json::object());
  chain.root["scenes"][0]["nodes"].push_back(18);
  EXPECT_EQ(refusal(chain), "") << "nodes that are no bones cost nothing";
  chain.root["skins"][0]["joints"] = json::array({200'018, 18});
  EXPECT_NE(refusal(chain), "");
  Asset stone = make_person();
  stone.root.erase("skins");
  stone.root["nodes"][17].erase("skin");
  for (json& node : stone.root["nodes"]) node.erase("name");
  EXPECT_NE(refusal(stone).find("not a figure"), std::string::npos);
}

TEST(GltfFigure, BadVrmIsRefusedWithItsPlace) {
  auto broken = [](const char* pointer, const json& value, bool version_0 = false) {
    Asset asset = make_person();
    if (version_0) add_vrm_0(asset);
    else add_vrm_1(asset);
    asset.root["extensions"][json::json_pointer(pointer)] = value;
    return refusal(asset);
  };
  EXPECT_NE(broken("/VRMC_vrm/humanoid", 3).find("/extensions/VRMC_vrm/humanoid"),
            std::string::npos);
  EXPECT_NE(broken("/VRMC_vrm/humanoid/humanBones/hips/node", 99).find("hips/node"),
            std::string::npos);
  EXPECT_NE(broken("/VRMC_vrm/humanoid/humanBones/hips/node", -7).find("hips/node"),
            std::string::npos);
  EXPECT_NE(broken("/VRMC_vrm/expressions/preset/aa", "x").find("preset/aa"), std::string::npos);
  EXPECT_NE(broken("/VRM/humanoid/humanBones", json::object(), true).find("must be a list"),
            std::string::npos);
  EXPECT_NE(
      broken("/VRM/blendShapeMaster/blendShapeGroups/0/binds/0/mesh", 5, true).find("binds/0/mesh"),
      std::string::npos);
  EXPECT_EQ(broken("/VRMC_vrm/humanoid/humanBones/tail", json{{"node", 3}}), "")
      << "unknown bones are told";
}

TEST(GltfFigure, EveryTruncationAndFlippedByteIsRefusedOrLoads) {
  Asset asset = make_person();
  add_vrm_1(asset);
  std::string whole = asset.glb();
  test::TemporaryFile file("", ".glb");
  for (size_t at = 0; at < whole.size(); at += 307)
    for (bool cut : {true, false}) {
      std::string bytes = cut ? whole.substr(0, at) : whole;
      if (!cut) bytes[at] = char(bytes[at] ^ 0x15);
      std::ofstream(file.path(), std::ios::binary | std::ios::trunc) << bytes;
      try {
        Character c = load_character(file.path());
        EXPECT_FALSE(cut) << at;
        for (vec3 p : c.positions) ASSERT_TRUE(is_finite(p));
      } catch (const LoadError&) {}
    }
}

}  // namespace
}  // namespace wellspring::test
