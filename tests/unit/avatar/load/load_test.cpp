// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "avatar/figure/hanim_names.h"
#include "base/load_error.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

bool warned(const Character& character, const std::string& part) {
  return std::any_of(character.warnings.begin(), character.warnings.end(),
                     [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

void expect_near(vec3 a, vec3 b, float tolerance = 1e-5f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

std::string refusal(const std::string& text) {
  try {
    load_text(text);
  } catch (const LoadError& error) {
    return error.where + ": " + error.what_;
  }
  return "";
}

std::string joint(const std::string& name, const std::string& inside = "",
                  const std::string& more = "") {
  return "<HAnimJoint name='" + name + "' " + more + ">" + inside + "</HAnimJoint>";
}

std::string humanoid(const std::string& inside) {
  return x3d("<HAnimHumanoid name='Test'>" + inside + "</HAnimHumanoid>");
}

const std::string root = "containerField='skeleton'";

TEST(HanimNames, LevelsHaveTheStandardsCounts) {
  int counts[5] = {};
  for (std::string_view name :
       {"humanoid_root", "l_knee", "r_knee", "vt10", "l_eyeball_joint", "l_midcarpal_1"})
    EXPECT_GE(hanim_joint_level(name), 0) << name;
  EXPECT_EQ(hanim_joint_level("l_knee"), 1);
  EXPECT_EQ(hanim_joint_level("vt10"), 2);
  EXPECT_EQ(hanim_joint_level("r_eyeball_joint"), 3);
  EXPECT_EQ(hanim_joint_level("r_midcarpal_4_5"), 4);
  EXPECT_EQ(hanim_joint_level("l_wrist"), -1) << "an alias is no joint name";
  (void)counts;
  EXPECT_EQ(hanim_joint_count(4), 146);
}

TEST(HanimNames, AliasesPrefixesAndBlanks) {
  EXPECT_EQ(hanim_joint_name("HumanoidRoot"), "humanoid_root");
  EXPECT_EQ(hanim_joint_name("hanim_HumanoidRoot"), "humanoid_root");
  EXPECT_EQ(hanim_joint_name("Joe_humanoid_root"), "humanoid_root");
  EXPECT_EQ(hanim_joint_name("l_wrist"), "l_radiocarpal");
  EXPECT_EQ(hanim_joint_name("Nancy_Old_r_ankle"), "r_talocrural");
  EXPECT_EQ(hanim_joint_name("r_thumb2"), "r_metacarpophalangeal_1");
  EXPECT_EQ(hanim_joint_name("l_pinky0"), "l_carpometacarpal_5");
  EXPECT_EQ(hanim_joint_name("l_tarsometatarsal_3 "), "l_tarsometatarsal_3");
  EXPECT_EQ(hanim_joint_name("l_midtarsal"), "l_metatarsophalangeal_2");
  EXPECT_EQ(hanim_joint_name("Hips"), "");
  EXPECT_EQ(hanim_joint_name(""), "");
  EXPECT_EQ(hanim_joint_name("_"), "");
}

TEST(Load, TreeNamesParentsCentres) {
  Character c = load_text(humanoid(
      joint("HumanoidRoot",
            joint("hanim_l_hip", joint("l_knee ", "", "center='0.1 0.5 0'"), "center='0.1 0.9 0'") +
                joint("l_index1"),
            root + " center='0 1 0'")));
  ASSERT_EQ(c.joints.size(), 4u);
  EXPECT_EQ(c.joints[0].name, "humanoid_root");
  EXPECT_EQ(c.joints[1].name, "l_hip");
  EXPECT_EQ(c.joints[2].name, "l_knee");
  EXPECT_EQ(c.joints[3].name, "l_metacarpophalangeal_2");
  EXPECT_EQ(c.joints[0].parent, -1);
  EXPECT_EQ(c.joints[1].parent, 0);
  EXPECT_EQ(c.joints[2].parent, 1);
  EXPECT_EQ(c.joints[3].parent, 0);
  EXPECT_EQ(c.loa, 0);
  EXPECT_EQ(find_joint(c, "l_knee"), 2);
  EXPECT_EQ(find_joint(c, "r_knee"), -1);
}

TEST(Load, SkeletonFieldForgottenAndOnlyAJointsList) {
  Character forgotten = load_text(humanoid(joint("humanoid_root", joint("vl5"))));
  EXPECT_EQ(forgotten.joints.size(), 2u);
  Character list = load_text(
      x3d("<Group><HAnimJoint DEF='a' name='humanoid_root'><HAnimJoint DEF='b' name='vl5'/>"
          "</HAnimJoint></Group><HAnimHumanoid><HAnimJoint USE='b' containerField='joints'/>"
          "<HAnimJoint USE='a' containerField='joints'/></HAnimHumanoid>"));
  EXPECT_EQ(list.joints.size(), 2u);
}

TEST(Load, HanimOneElementsAndPrototypeInstances) {
  Character c =
      load_text(x3d("<Humanoid name='Old'><Joint name='HumanoidRoot' containerField='skeleton'>"
                    "<Segment name='pelvis'><Shape><Box/></Shape></Segment></Joint></Humanoid>"));
  EXPECT_EQ(c.joints.size(), 1u);
  EXPECT_EQ(c.segments.size(), 1u);
  EXPECT_EQ(c.parts.size(), 1u);
  Character p =
      load_text(x3d("<ProtoDeclare name='Joint'><ProtoBody><Transform/></ProtoBody></ProtoDeclare>"
                    "<ProtoInstance name='Humanoid'><fieldValue name='name' "
                    "value='Proto'/><fieldValue name='humanoidBody'>"
                    "<ProtoInstance name='Joint'><fieldValue name='name' "
                    "value='HumanoidRoot'/><fieldValue name='center' value='0 1 0'/>"
                    "<fieldValue name='children'><ProtoInstance name='Joint'><fieldValue "
                    "name='name' value='l_hip'/></ProtoInstance>"
                    "</fieldValue></ProtoInstance></fieldValue></ProtoInstance>"));
  EXPECT_EQ(p.name, "Proto");
  ASSERT_EQ(p.joints.size(), 2u);
  EXPECT_EQ(p.joints[1].name, "l_hip");
  expect_near(p.joints[0].center, {0, 1, 0});
}

TEST(Load, SegmentsFollowTheirJointThroughNestedTransforms) {
  Character c =
      load_text(humanoid(joint("humanoid_root",
                               joint("vl5",
                                     "<HAnimSegment name='l5'><Transform translation='0 1 "
                                     "0'><Group><Transform scale='2 2 2'><Shape>"
                                     "<TriangleSet><Coordinate point='0 0 0 1 0 0 0 1 "
                                     "0'/></TriangleSet></Shape></Transform></Group>"
                                     "</Transform></HAnimSegment><HAnimSite "
                                     "name='l5_view'><Transform translation='0 0 3'/></HAnimSite>"),
                               root)));
  ASSERT_EQ(c.positions.size(), 3u);
  expect_near(c.positions[1], {2, 1, 0});
  expect_near(c.positions[2], {0, 3, 0});
  expect_near(c.normals[0], {0, 0, 1});
  for (size_t v = 0; v < 3; v++) {
    ASSERT_EQ(c.first_weight[v + 1] - c.first_weight[v], 1u);
    EXPECT_EQ(c.weights[c.first_weight[v]].joint, 1);
  }
  ASSERT_EQ(c.sites.size(), 1u);
  EXPECT_EQ(c.sites[0].joint, 1);
}

TEST(Load, HumanoidScaleAndTransformsAboveItCountButItsPlaceDoesNot) {
  Character c =
      load_text(x3d("<Transform translation='5 5 5' scale='2 2 2'><HAnimHumanoid scale='0.5 0.5 "
                    "0.5' translation='9 9 9'>" +
                    joint("humanoid_root", joint("vl5", "", "center='0 1 0.5'"), root) +
                    "</HAnimHumanoid></Transform>"));
  expect_near(c.joints[1].center, {0, 1, 0.5});
  Character lying = load_text(x3d("<Transform rotation='1 0 0 -1.5707963'><HAnimHumanoid>" +
                                  joint("humanoid_root", joint("vl5", "", "center='0 0 1'"), root) +
                                  "</HAnimHumanoid></Transform>"));
  expect_near(lying.joints[1].center, {0, 1, 0});
}

TEST(Load, FigureIsPutOnTheFloorAndSaysSo) {
  Character c = load_text(humanoid(joint("humanoid_root",
                                         joint("l_knee",
                                               "<HAnimSegment><Transform translation='0 -1 0'>"
                                               "<Shape><Box/></Shape></Transform></HAnimSegment>"),
                                         root)));
  float low = 1e9f;
  for (vec3 p : c.positions) low = std::min(low, p.y);
  EXPECT_NEAR(low, 0, 1e-5f);
  expect_near(c.joints[0].center, {0, 2, 0});
  EXPECT_TRUE(warned(c, "feet are at y = -2.000"));
}

TEST(Load, PoseInTheFileIsNotedButRestIsTheDefaultPose) {
  Character c = load_text(humanoid(
      joint("humanoid_root", joint("vl5", "", "rotation='1 0 0 1' center='0 1 0'"), root)));
  EXPECT_NEAR(c.joints[1].rest_rotation.x, std::sin(0.5f), 1e-5f);
  EXPECT_TRUE(warned(c, "poses the figure"));
}

TEST(Load, SkinWeightsAreNormalisedAndLooseVerticesFollowTheRoot) {
  std::string text =
      humanoid(joint("humanoid_root",
                     joint("vl5", "", "skinCoordIndex='1 2 7 -1' skinCoordWeight='3 0.5 1 1'"),
                     root + " skinCoordIndex='1 2' skinCoordWeight='1 -2'") +
               "<Shape containerField='skin'><IndexedTriangleSet index='0 1 2'><Coordinate DEF='p' "
               "point='0 0 0 1 0 0 0 1 0'/>"
               "</IndexedTriangleSet></Shape><Coordinate USE='p' containerField='skinCoord'/>");
  Character c = load_text(text);
  ASSERT_EQ(c.first_weight.size(), 4u);
  for (size_t v = 0; v < 3; v++) {
    float sum = 0;
    for (uint32_t k = c.first_weight[v]; k < c.first_weight[v + 1]; k++) sum += c.weights[k].weight;
    EXPECT_NEAR(sum, 1, 1e-6f);
  }
  EXPECT_EQ(c.weights[c.first_weight[0]].joint, 0) << "no weight: the root";
  EXPECT_NEAR(c.weights[c.first_weight[1]].weight, 0.25f, 1e-6f);
  EXPECT_EQ(c.first_weight[3] - c.first_weight[2], 1u) << "the negative weight is left out";
  EXPECT_TRUE(warned(c, "2 entries of skinCoordIndex are out of range"));
  EXPECT_TRUE(warned(c, "1 skin weights are negative"));
  EXPECT_TRUE(warned(c, "1 points of the skin have no weight"));
}

TEST(Load, SkinCoordThatIsAnotherNodeOfTheSameLength) {
  Character c = load_text(
      humanoid(joint("humanoid_root",
                     joint("vl5", "", "skinCoordIndex='0 1 2' skinCoordWeight='1 1 1'"), root) +
               "<Shape containerField='skin'><IndexedTriangleSet index='0 1 2'><Coordinate "
               "point='0 0 0 1 0 0 0 1 0'/>"
               "</IndexedTriangleSet></Shape><Coordinate containerField='skinCoord' point='0 0 0 1 "
               "0 0 0 1 0'/>"));
  ASSERT_EQ(c.weights.size(), 3u);
  EXPECT_EQ(c.weights[0].joint, 1);
  EXPECT_TRUE(warned(c, "not the skinCoord node"));
}

TEST(Load, SmoothAndFacetedNormals) {
  // Two faces at a right angle over one edge.
  auto make = [](const std::string& attributes) {
    return load_text(
        humanoid(joint("humanoid_root",
                       "<HAnimSegment><Shape><IndexedFaceSet " + attributes +
                           " coordIndex='0 1 2 -1 1 0 3 -1'><Coordinate point='0 0 0 1 0 0 0 "
                           "1 0 0 0 1'/></IndexedFaceSet></Shape></HAnimSegment>",
                       root)));
  };
  EXPECT_EQ(make("").positions.size(), 6u);
  EXPECT_EQ(make("creaseAngle='1.0'").positions.size(), 6u);
  Character smooth = make("creaseAngle='2'");
  EXPECT_EQ(smooth.positions.size(), 4u);
  expect_near(smooth.normals[0], normalize(vec3(0, 1, 1)));
  Character flipped = make("ccw='false'");
  expect_near(flipped.normals[0], {0, 0, -1});
  EXPECT_FALSE(smooth.appearances[size_t(smooth.parts[0].appearance)].double_sided);
  EXPECT_TRUE(make("solid='false'").appearances[0].double_sided);
}

TEST(Load, GivenNormalsAndTextureCoordinatesByTheirOwnIndex) {
  Character c = load_text(humanoid(joint(
      "humanoid_root",
      "<HAnimSegment><Shape><IndexedFaceSet coordIndex='0 1 2 -1' texCoordIndex='2 1 0' "
      "normalPerVertex='false'>"
      "<Coordinate point='0 0 0 1 0 0 0 1 0'/><TextureCoordinate point='0.1 0.2 0.3 0.4 0.5 0.6'/>"
      "<Normal vector='0 3 4'/></IndexedFaceSet></Shape></HAnimSegment>",
      root)));
  ASSERT_EQ(c.uv.size(), 3u);
  EXPECT_FLOAT_EQ(c.uv[0].x, 0.5f);
  EXPECT_FLOAT_EQ(c.uv[0].y, 1 - 0.6f) << "the picture's top is 0";
  expect_near(c.normals[2], {0, 0.6f, 0.8f});
}

TEST(Load, ConcavePolygonIsCutWithoutCoveringItsNotch) {
  // A square with a deep notch from the right: area 4 - 1.8.
  Character c = load_text(humanoid(joint(
      "humanoid_root",
      "<HAnimSegment><Shape><IndexedFaceSet convex='false' coordIndex='0 1 2 3 4 -1'><Coordinate "
      "point='0 0 0 2 0 0 0.2 1 0 2 2 0 0 2 0'/></IndexedFaceSet></Shape></HAnimSegment>",
      root)));
  ASSERT_EQ(c.parts[0].triangles.size(), 3u);
  float area = 0;
  for (uvec3 t : c.parts[0].triangles) {
    vec3 n = cross(c.positions[t.y] - c.positions[t.x], c.positions[t.z] - c.positions[t.x]);
    EXPECT_GE(n.z, 0);
    area += 0.5f * glm::length(n);
  }
  EXPECT_NEAR(area, 2.2f, 1e-5f);
}

TEST(Load, OtherTriangleNodesGiveTheTrianglesTheyName) {
  auto count = [](const std::string& geometry) {
    Character c = load_text(humanoid(joint(
        "humanoid_root", "<HAnimSegment><Shape>" + geometry + "</Shape></HAnimSegment>", root)));
    return c.parts.empty() ? size_t(0) : c.parts[0].triangles.size();
  };
  std::string p = "<Coordinate point='0 0 0 1 0 0 1 1 0 0 1 0 0 2 0'/>";
  EXPECT_EQ(
      count("<IndexedTriangleStripSet index='0 1 3 2 4 -1'>" + p + "</IndexedTriangleStripSet>"),
      3u);
  EXPECT_EQ(count("<TriangleFanSet fanCount='5'>" + p + "</TriangleFanSet>"), 3u);
  EXPECT_EQ(count("<IndexedQuadSet index='0 1 2 3'>" + p + "</IndexedQuadSet>"), 2u);
  EXPECT_EQ(count("<Box/>"), 12u);
  EXPECT_GT(count("<Sphere radius='0.1'/>"), 100u);
  EXPECT_GT(count("<Cylinder/>"), count("<Cylinder top='false'/>"));
  EXPECT_EQ(count("<IndexedLineSet coordIndex='0 1'>" + p + "</IndexedLineSet>"), 0u);
}

TEST(Load, PrimitivesFaceOutwards) {
  for (const char* shape : {"<Box/>", "<Sphere/>", "<Cone/>", "<Cylinder/>"}) {
    Character c = load_text(humanoid(
        joint("humanoid_root",
              std::string("<HAnimSegment><Shape>") + shape + "</Shape></HAnimSegment>", root)));
    for (uvec3 t : c.parts[0].triangles) {
      vec3 middle = (c.positions[t.x] + c.positions[t.y] + c.positions[t.z]) / 3.0f;
      vec3 n = cross(c.positions[t.y] - c.positions[t.x], c.positions[t.z] - c.positions[t.x]);
      EXPECT_GT(dot(n, middle + vec3(0, 0.3f, 0)), 0) << shape;
      EXPECT_GT(dot(n, c.normals[t.x]), 0) << shape;
    }
  }
}

TEST(Load, LooksOfBothMaterials) {
  Character c = load_text(
      humanoid(joint("humanoid_root",
                     "<HAnimSegment><Shape><Appearance><Material DEF='Red' diffuseColor='1 0 0' "
                     "transparency='0.25'/></Appearance><Box/></Shape>"
                     "<Shape><Appearance><PhysicalMaterial baseColor='0.5 0.5 0.5' metallic='0.3' "
                     "roughness='0.2'/><ImageTexture "
                     "url='\"missing.png\"'/></Appearance><Box/></Shape></HAnimSegment>",
                     root)));
  ASSERT_EQ(c.appearances.size(), 2u);
  EXPECT_EQ(c.appearances[0].name, "Red");
  expect_near(c.appearances[0].base_color, {1, 0, 0});
  EXPECT_FLOAT_EQ(c.appearances[0].alpha, 0.75f);
  EXPECT_FLOAT_EQ(c.appearances[1].metallic, 0.3f);
  expect_near(c.appearances[1].base_color, vec3(0.5f));
  EXPECT_TRUE(c.appearances[1].texture.empty());
  EXPECT_TRUE(warned(c, "no picture 'missing.png'"));
}

TEST(Load, DisplacersOfSegmentsAndOfTheSkin) {
  Character c = load_text(test::small_skin(
      "<HAnimDisplacer name='rise' coordIndex='3 9' displacements='0 0 1 5 5 5'/>"
      "<HAnimSegment name='l5'><Transform scale='2 2 2'><Shape><IndexedTriangleSet index='0 1 "
      "2'><Coordinate DEF='q' "
      "point='0 0 0 1 0 0 0 1 0'/></IndexedTriangleSet></Shape></Transform>"
      "<Coordinate USE='q' containerField='coord'/>"
      "<HAnimDisplacer name='grow' coordIndex='1' displacements='1 0 0'/></HAnimSegment>"));
  int rise = find_displacer(c, "rise"), grow = find_displacer(c, "grow");
  ASSERT_GE(rise, 0);
  ASSERT_GE(grow, 0);
  const Displacer& r = c.displacers[size_t(rise)];
  ASSERT_EQ(r.vertices.size(), 1u);
  expect_near(c.positions[r.vertices[0]], {1, 2, 0});
  expect_near(r.displacements[0], {0, 0, 1});
  const Displacer& g = c.displacers[size_t(grow)];
  ASSERT_EQ(g.vertices.size(), 1u);
  expect_near(c.positions[g.vertices[0]], {2, 0, 0});
  expect_near(g.displacements[0], {2, 0, 0});
  EXPECT_TRUE(warned(c, "1 indices out of range"));
}

TEST(Load, MotionsAndUnknownThingsAreNamed) {
  Character c =
      load_text(humanoid(joint("humanoid_root", "<Text/><Inline url='x'/><Inline url='y'/>", root) +
                         "<HAnimMotion name='walk' containerField='motions'/>"));
  ASSERT_EQ(c.motions.size(), 1u);
  EXPECT_EQ(c.motions[0].name, "walk");
  EXPECT_EQ(
      std::count_if(c.warnings.begin(), c.warnings.end(),
                    [](const std::string& w) { return w.find("Inline") != std::string::npos; }),
      1);
}

TEST(Refuse, WithFileAndPlace) {
  EXPECT_NE(refusal(x3d("<Group/>")).find("no HAnimHumanoid"), std::string::npos);
  EXPECT_NE(refusal(humanoid("")).find("no joints"), std::string::npos);
  EXPECT_NE(refusal("hello").find("no X3D"), std::string::npos);
  EXPECT_NE(refusal("<html/>").find("not X3D"), std::string::npos);
  EXPECT_NE(refusal("").find("empty"), std::string::npos);
  EXPECT_THROW(load_character("/nonexistent/figure.x3d"), LoadError);
  EXPECT_THROW(load_character("/tmp"), LoadError);
  std::string place = refusal(
      "<X3D>\n<Scene>\n<HAnimHumanoid>\n<HAnimJoint name='humanoid_root' center='0 x 0'/>"
      "</HAnimHumanoid></Scene></X3D>");
  EXPECT_NE(place.find("line 4"), std::string::npos) << place;
  EXPECT_NE(place.find("'x'"), std::string::npos) << place;
}

TEST(Refuse, NumbersThatAreNone) {
  for (const char* bad : {"nan 1 1", "1 inf 1", "1e99 0 0", "1 2", "1;2;3", "0 0 --1"})
    EXPECT_NE(refusal(humanoid(joint("humanoid_root", "", root + " center='" + bad + "'"))), "")
        << bad;
  EXPECT_NE(refusal(humanoid(
                joint("humanoid_root", "", root + " skinCoordIndex='0' skinCoordWeight='nan'") +
                "<Shape containerField='skin'><TriangleSet><Coordinate DEF='p' point='0 0 0 1 0 0 "
                "0 1 0'/>"
                "</TriangleSet></Shape><Coordinate USE='p' containerField='skinCoord'/>")),
            "");
}

TEST(Refuse, Cycles) {
  EXPECT_NE(
      refusal(
          x3d("<HAnimHumanoid><HAnimJoint DEF='a' name='humanoid_root' containerField='skeleton'>"
              "<HAnimJoint USE='a'/></HAnimJoint></HAnimHumanoid>"))
          .find("inside itself"),
      std::string::npos);
  EXPECT_NE(
      refusal(x3d("<Group DEF='a'><Group USE='b'/></Group><Group DEF='b'><Group USE='a'/></Group>"))
          .find("inside itself"),
      std::string::npos);
}

TEST(Refuse, TreesThatUnfoldWithoutEnd) {
  std::string scene = "<Group DEF='g0'><Transform/></Group>";
  for (int i = 1; i < 60; i++) {
    std::string inner = "<Group USE='g" + std::to_string(i - 1) + "'/>";
    scene += "<Group DEF='g" + std::to_string(i) + "'>" + inner + inner + "</Group>";
  }
  std::string text = x3d(scene + "<HAnimHumanoid>" +
                         joint("humanoid_root", "<Group USE='g59'/>", root) + "</HAnimHumanoid>");
  EXPECT_NE(refusal(text).find("too large"), std::string::npos);
}

TEST(Refuse, DeepNestingAndTooManyJoints) {
  std::string open, close;
  for (int i = 0; i < 100000; i++) open += "<Group>", close += "</Group>";
  EXPECT_NE(refusal(x3d(open + close)).find("deeper"), std::string::npos);
  std::string many = "<HAnimHumanoid>";
  for (int i = 0; i < 5000; i++) many += "<HAnimJoint containerField='skeleton'/>";
  EXPECT_NE(refusal(x3d(many + "</HAnimHumanoid>")).find("more than 4096 joints"),
            std::string::npos);
  std::string nodes;
  for (int i = 0; i < 510000; i++) nodes += "<Group/>";
  EXPECT_NE(refusal(x3d(nodes)).find("nodes"), std::string::npos);
}

TEST(Refuse, EveryTruncationIsRefusedOrLoads) {
  std::string text =
      test::small_skin("<HAnimDisplacer name='rise' coordIndex='3' displacements='0 0 1'/>");
  test::TemporaryFile file("");
  for (size_t length = 1; length < text.size(); length += 13) {
    std::ofstream(file.path(), std::ios::binary | std::ios::trunc) << text.substr(0, length);
    EXPECT_THROW(load_character(file.path()), LoadError) << length;
  }
}

TEST(Refuse, EveryFlippedByteIsRefusedOrLoads) {
  std::string text =
      test::small_skin("<HAnimDisplacer name='rise' coordIndex='3' displacements='0 0 1'/>");
  int loaded = 0;
  for (size_t at = 0; at < text.size(); at += 3) {
    std::string broken = text;
    broken[at] = char(broken[at] ^ 0x15);
    try {
      Character c = load_text(broken);
      for (const Part& part : c.parts)
        for (uvec3 t : part.triangles) EXPECT_LT(std::max({t.x, t.y, t.z}), c.positions.size());
      loaded++;
    } catch (const LoadError&) {}
  }
  EXPECT_GT(loaded, 10);
}

}  // namespace
}  // namespace wellspring::test
