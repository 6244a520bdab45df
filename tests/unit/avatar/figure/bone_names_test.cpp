// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "avatar/figure/bone_names.h"
#include "avatar/figure/hanim_names.h"
#include "unit/avatar/load/gltf_person.h"

namespace wellspring::test {
namespace {

using Tree = std::vector<std::pair<std::string, int>>;

std::map<std::string, std::string> named(const Tree& tree) {
  std::vector<Bone> bones;
  for (const auto& [name, parent] : tree) bones.push_back({name, parent, vec3(0)});
  BoneNames names = name_bones(bones);
  EXPECT_FALSE(names.by_shape);
  std::map<std::string, std::string> result;
  for (size_t i = 0; i < bones.size(); i++) {
    result[tree[i].first] = names.joints[i];
    if (!names.joints[i].empty())
      EXPECT_GE(hanim_joint_level(names.joints[i]), 0) << names.joints[i];
  }
  return result;
}

TEST(BoneNames, Mixamo) {
  auto n = named({{"mixamorig:Hips", -1},
                  {"mixamorig:Spine", 0},
                  {"mixamorig:Spine1", 1},
                  {"mixamorig:Spine2", 2},
                  {"mixamorig:Neck", 3},
                  {"mixamorig:Head", 4},
                  {"mixamorig:HeadTop_End", 5},
                  {"mixamorig:LeftShoulder", 3},
                  {"mixamorig:LeftArm", 7},
                  {"mixamorig:LeftForeArm", 8},
                  {"mixamorig:LeftHand", 9},
                  {"mixamorig:LeftHandThumb1", 10},
                  {"mixamorig:LeftHandThumb2", 11},
                  {"mixamorig:LeftHandIndex1", 10},
                  {"mixamorig:LeftHandIndex2", 13},
                  {"mixamorig:LeftHandIndex3", 14},
                  {"mixamorig:LeftHandIndex4", 15},
                  {"mixamorig:RightShoulder", 3},
                  {"mixamorig:RightArm", 17},
                  {"mixamorig:RightForeArm", 18},
                  {"mixamorig:LeftUpLeg", 0},
                  {"mixamorig:LeftLeg", 20},
                  {"mixamorig:LeftFoot", 21},
                  {"mixamorig:LeftToeBase", 22},
                  {"mixamorig:RightUpLeg", 0}});
  EXPECT_EQ(n["mixamorig:Hips"], "humanoid_root");
  EXPECT_EQ(n["mixamorig:Spine"], "vl5");
  EXPECT_EQ(n["mixamorig:Spine1"], "vt10");
  EXPECT_EQ(n["mixamorig:Spine2"], "vt6");
  EXPECT_EQ(n["mixamorig:Neck"], "vc4");
  EXPECT_EQ(n["mixamorig:Head"], "skullbase");
  EXPECT_EQ(n["mixamorig:HeadTop_End"], "");
  EXPECT_EQ(n["mixamorig:LeftShoulder"], "l_sternoclavicular");
  EXPECT_EQ(n["mixamorig:LeftArm"], "l_shoulder");
  EXPECT_EQ(n["mixamorig:RightForeArm"], "r_elbow");
  EXPECT_EQ(n["mixamorig:LeftHand"], "l_radiocarpal");
  EXPECT_EQ(n["mixamorig:LeftHandThumb2"], "l_metacarpophalangeal_1");
  EXPECT_EQ(n["mixamorig:LeftHandIndex1"], "l_metacarpophalangeal_2");
  EXPECT_EQ(n["mixamorig:LeftHandIndex3"], "l_carpal_distal_interphalangeal_2");
  EXPECT_EQ(n["mixamorig:LeftHandIndex4"], "");
  EXPECT_EQ(n["mixamorig:LeftUpLeg"], "l_hip");
  EXPECT_EQ(n["mixamorig:LeftLeg"], "l_knee");
  EXPECT_EQ(n["mixamorig:LeftToeBase"], "l_metatarsophalangeal_2");
}

TEST(BoneNames, UnrealWithTwistBonesAndTargets) {
  auto n = named({{"root", -1},
                  {"pelvis", 0},
                  {"spine_01", 1},
                  {"spine_02", 2},
                  {"spine_03", 3},
                  {"clavicle_l", 4},
                  {"upperarm_l", 5},
                  {"upperarm_twist_01_l", 6},
                  {"lowerarm_l", 6},
                  {"hand_l", 8},
                  {"index_metacarpal_l", 9},
                  {"index_01_l", 10},
                  {"index_02_l", 11},
                  {"index_03_l", 12},
                  {"clavicle_r", 4},
                  {"upperarm_r", 14},
                  {"neck_01", 4},
                  {"head", 16},
                  {"thigh_l", 1},
                  {"calf_l", 18},
                  {"foot_l", 19},
                  {"ball_l", 20},
                  {"thigh_r", 1},
                  {"ik_foot_root", 0},
                  {"ik_foot_l", 23}});
  EXPECT_EQ(n["root"], "");
  EXPECT_EQ(n["pelvis"], "humanoid_root");
  EXPECT_EQ(n["upperarm_l"], "l_shoulder");
  EXPECT_EQ(n["upperarm_twist_01_l"], "");
  EXPECT_EQ(n["lowerarm_l"], "l_elbow");
  EXPECT_EQ(n["index_metacarpal_l"], "l_carpometacarpal_2");
  EXPECT_EQ(n["index_01_l"], "l_metacarpophalangeal_2");
  EXPECT_EQ(n["index_03_l"], "l_carpal_distal_interphalangeal_2");
  EXPECT_EQ(n["calf_l"], "l_knee");
  EXPECT_EQ(n["ball_l"], "l_metatarsophalangeal_2");
  EXPECT_EQ(n["ik_foot_l"], "");
}

TEST(BoneNames, BipedFingersAndRigifysSpine) {
  auto n = named({{"Bip01", -1},
                  {"Bip01 Pelvis", 0},
                  {"Bip01 Spine", 1},
                  {"Bip01 Neck", 2},
                  {"Bip01 Head", 3},
                  {"Bip01 L Clavicle", 3},
                  {"Bip01 L UpperArm", 5},
                  {"Bip01 L Forearm", 6},
                  {"Bip01 L Hand", 7},
                  {"Bip01 L Finger0", 8},
                  {"Bip01 L Finger1", 8},
                  {"Bip01 L Finger11", 10},
                  {"Bip01 L Finger1Nub", 11},
                  {"Bip01 R Clavicle", 3},
                  {"Bip01 R UpperArm", 13},
                  {"Bip01 L Thigh", 2},
                  {"Bip01 L Calf", 15},
                  {"Bip01 L Foot", 16},
                  {"Bip01 L Toe0", 17},
                  {"Bip01 R Thigh", 2}});
  EXPECT_EQ(n["Bip01 Pelvis"], "humanoid_root");
  EXPECT_EQ(n["Bip01 L Finger0"], "l_carpometacarpal_1");
  EXPECT_EQ(n["Bip01 L Finger11"], "l_carpal_proximal_interphalangeal_2");
  EXPECT_EQ(n["Bip01 L Toe0"], "l_metatarsophalangeal_2");
  n = named({{"DEF-spine", -1},          {"DEF-spine.001", 0},  {"DEF-spine.002", 1},
             {"DEF-spine.003", 2},       {"DEF-spine.004", 3},  {"DEF-spine.005", 4},
             {"DEF-spine.006", 5},       {"DEF-shoulder.L", 3}, {"DEF-upper_arm.L", 7},
             {"DEF-upper_arm.L.001", 8}, {"DEF-forearm.L", 9},  {"DEF-hand.L", 10},
             {"DEF-f_index.01.L", 11},   {"DEF-shoulder.R", 3}, {"DEF-upper_arm.R", 13},
             {"DEF-thigh.L", 0},         {"DEF-shin.L", 15},    {"DEF-foot.L", 16},
             {"DEF-thigh.R", 0},         {"DEF-eye.L", 6},      {"DEF-jaw", 6}});
  EXPECT_EQ(n["DEF-spine"], "humanoid_root");
  EXPECT_EQ(n["DEF-spine.001"], "vl5");
  EXPECT_EQ(n["DEF-spine.004"], "vc4");
  EXPECT_EQ(n["DEF-spine.006"], "skullbase");
  EXPECT_EQ(n["DEF-upper_arm.L"], "l_shoulder");
  EXPECT_EQ(n["DEF-upper_arm.L.001"], "");
  EXPECT_EQ(n["DEF-f_index.01.L"], "l_metacarpophalangeal_2");
  EXPECT_EQ(n["DEF-eye.L"], "l_eyeball_joint");
  EXPECT_EQ(n["DEF-jaw"], "temporomandibular");
}

// "Shoulder" and "Hip" mean upper arm and thigh where collar and leg have their own words.
TEST(BoneNames, MotionCaptureMeansOtherBonesByTheSameWords) {
  auto n = named({{"Hips", -1},
                  {"Chest", 0},
                  {"LeftCollar", 1},
                  {"LeftShoulder", 2},
                  {"LeftElbow", 3},
                  {"LeftWrist", 4},
                  {"RightCollar", 1},
                  {"RightShoulder", 6},
                  {"Neck", 1},
                  {"Head", 8},
                  {"LeftHip", 0},
                  {"LeftKnee", 10},
                  {"LeftAnkle", 11},
                  {"RightHip", 0}});
  EXPECT_EQ(n["LeftCollar"], "l_sternoclavicular");
  EXPECT_EQ(n["LeftShoulder"], "l_shoulder");
  EXPECT_EQ(n["LeftElbow"], "l_elbow");
  EXPECT_EQ(n["LeftWrist"], "l_radiocarpal");
  EXPECT_EQ(n["LeftHip"], "l_hip");
  EXPECT_EQ(n["LeftAnkle"], "l_talocrural");
  n = named({{"Hips", -1},
             {"LHipJoint", 0},
             {"LeftUpLeg", 1},
             {"LeftLeg", 2},
             {"LeftFoot", 3},
             {"RHipJoint", 0},
             {"RightUpLeg", 5},
             {"LowerBack", 0},
             {"Spine", 7},
             {"LeftShoulder", 8},
             {"LeftArm", 9},
             {"LeftForeArm", 10},
             {"RightShoulder", 8},
             {"RightArm", 12},
             {"Neck", 8},
             {"Head", 14}});
  EXPECT_EQ(n["LHipJoint"], "");
  EXPECT_EQ(n["LeftUpLeg"], "l_hip");
  EXPECT_EQ(n["LowerBack"], "vl5");
  EXPECT_EQ(n["LeftShoulder"], "l_sternoclavicular");
}

TEST(BoneNames, WordsThatAreNoBody) {
  for (const char* name :
       {"HairFront1", "J_Sec_L_Bust1", "SkirtLeft", "LeftHandProp", "CameraTarget", "Box01", ""})
    EXPECT_TRUE(read_bone_name(name).part == BonePart::none ||
                read_bone_name(name).part == BonePart::helper)
        << name;
  EXPECT_EQ(read_bone_name("rightUpperArm").side, 1);
  EXPECT_EQ(read_bone_name("upperarm_l").side, 0);
  EXPECT_EQ(read_bone_name("Arm").part, BonePart::none) << "of which side?";
}

TEST(BoneNames, ShapeAloneIsEnough) {
  std::vector<Bone> bones;
  for (const test::PersonBone& bone : test::person_bones())
    bones.push_back({"", bone.parent[0] ? test::person_bone(bone.parent) : -1, bone.place});
  for (const char* toe : {"leftFoot", "rightFoot"})  // feet point ahead
    bones.push_back(
        {"", test::person_bone(toe), test::person_bones()[size_t(test::person_bone(toe))].to});
  for (float turned : {0.0f, pi / 2, pi}) {
    std::vector<Bone> turn = bones;
    for (Bone& bone : turn) bone.place = glm::angleAxis(turned, vec3(0, 1, 0)) * bone.place;
    BoneNames names = name_bones(turn);
    EXPECT_TRUE(names.by_shape);
    EXPECT_EQ(names.joints[0], "humanoid_root");
    EXPECT_EQ(names.joints[size_t(test::person_bone("chest"))], "vt10");
    EXPECT_EQ(names.joints[size_t(test::person_bone("head"))], "skullbase");
    EXPECT_EQ(names.joints[size_t(test::person_bone("leftLowerArm"))], "l_elbow");
    EXPECT_EQ(names.joints[size_t(test::person_bone("rightUpperLeg"))], "r_hip");
    EXPECT_EQ(names.joints[17], "l_metatarsophalangeal_2");
    std::vector<vec3> places;
    for (const Bone& bone : turn) places.push_back(bone.place);
    vec3 nose = upright_turn(names.joints, places) * (turn[17].place - turn[13].place);
    EXPECT_GT(nose.z, 0.1f);
  }
}

TEST(BoneNames, NoPersonIsNone) {
  std::vector<Bone> chain;
  for (int i = 0; i < 20; i++) chain.push_back({"", i - 1, vec3(0, float(i), 0)});
  for (const std::string& joint : name_bones(chain).joints) EXPECT_TRUE(joint.empty());
  std::vector<Bone> star{{"", -1, vec3(NAN)}};
  for (int i = 0; i < 300; i++) star.push_back({"", 0, vec3(float(i % 7), 0, 0)});
  EXPECT_EQ(name_bones(star).joints.size(), 301u);
}

}  // namespace
}  // namespace wellspring::test
