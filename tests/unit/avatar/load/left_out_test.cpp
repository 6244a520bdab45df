// SPDX-License-Identifier: Apache-2.0
// What a file hides is not shown, colours of vertices are, and what is dropped is said once.
#include <gtest/gtest.h>

#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

const std::string one_joint =
    "<HAnimJoint containerField='skeleton' name='humanoid_root' skinCoordIndex='0 1 2 3' "
    "skinCoordWeight='1 1 1 1'/>"
    "<Coordinate DEF='p' containerField='skinCoord' point='0 0 0 1 0 0 1 1 0 0 1 0'/>";

std::string skin_figure(const std::string& skin, const std::string& beside = "") {
  return test::x3d("<HAnimHumanoid>" + one_joint + skin + "</HAnimHumanoid>" + beside);
}

std::string colored(const std::string& name, const std::string& faces = "coordIndex='0 1 2 3'",
                    const std::string& more = "",
                    const std::string& material = "<Material diffuseColor='0 1 0'/>") {
  return "<Shape DEF='" + name + "'><Appearance>" + material + "</Appearance><IndexedFaceSet " +
         faces + "><Coordinate USE='p'/>" + more + "</IndexedFaceSet></Shape>";
}

std::string in_skin(const std::string& shape) {
  return "<Group containerField='skin'>" + shape + "</Group>";
}

std::string parts_of(const Character& character) {
  std::string names;
  for (const Part& part : character.parts) names += part.name + " ";
  return names;
}

TEST(Hidden, ASwitchShowsItsChoiceAlone) {
  for (auto [choice, shown] :
       {std::pair("whichChoice='0'", "a "), std::pair("whichChoice='1'", "b "),
        std::pair("whichChoice='-1'", ""), std::pair("whichChoice='2'", ""), std::pair("", "")}) {
    std::string inside = std::string("<Switch containerField='skin' ") + choice +
                         "><MetadataString name='x'/>" + colored("a") + colored("b") + "</Switch>";
    EXPECT_EQ(parts_of(test::load_text(skin_figure(inside))), shown) << choice;
    std::string segment = std::string(
                              "<HAnimHumanoid><HAnimJoint containerField='skeleton' "
                              "name='humanoid_root'><HAnimSegment><Switch ") +
                          choice + "><Shape DEF='a'><Box/></Shape><Shape DEF='b'><Box/></Shape>" +
                          "</Switch></HAnimSegment></HAnimJoint></HAnimHumanoid>";
    EXPECT_EQ(parts_of(test::load_text(test::x3d(segment))), shown) << choice;
  }
}

TEST(Hidden, AnLodShowsItsFirstLevelAndInvisibleGroupsNothing) {
  EXPECT_EQ(parts_of(test::load_text(skin_figure("<LOD containerField='skin'>" + colored("a") +
                                                 colored("b") + "</LOD>"))),
            "a ");
  EXPECT_EQ(
      parts_of(test::load_text(skin_figure("<Group containerField='skin' visible='false'>" +
                                           colored("a") + "</Group>" + in_skin(colored("b"))))),
      "b ");
}

TEST(Hidden, TheHumanoidThatASwitchShowsIsRead) {
  auto named = [](const std::string& name) {
    return "<HAnimHumanoid name='" + name + "'>" +
           "<HAnimJoint containerField='skeleton' name='humanoid_root'/></HAnimHumanoid>";
  };
  std::string two = named("first") + named("second") + "</Switch>";
  EXPECT_EQ(test::load_text(test::x3d("<Switch whichChoice='1'>" + two)).name, "second");
  Character hidden = test::load_text(test::x3d("<Switch>" + two));
  EXPECT_EQ(hidden.name, "first");
  EXPECT_TRUE(test::says(hidden, "the first that it hides is used"));
}

TEST(VertexColors, TakeThePlaceOfTheMaterials) {
  const std::string rgb = "<Color color='1 0 0 0 0 1 0.5 0.5 0.5 1 1 1'/>";
  Character c = test::load_text(
      skin_figure(in_skin(colored("a", "coordIndex='0 1 2 3'", rgb)) + in_skin(colored("plain"))));
  ASSERT_EQ(c.appearances.size(), 2u);
  EXPECT_EQ(c.appearances[0].base_color, vec3(1));
  EXPECT_NEAR(c.appearances[1].base_color.y, 1, 1e-6f);
  ASSERT_EQ(c.colors.size(), c.positions.size());
  for (uvec3 t : c.parts[1].triangles) EXPECT_EQ(c.colors[t.x], vec4(1)) << "of the part without";
  EXPECT_EQ(c.colors[0], vec4(1, 0, 0, 1));
  EXPECT_EQ(c.colors[1], vec4(0, 0, 1, 1));
  EXPECT_NEAR(c.colors[2].x, 0.2140f, 1e-4f) << "as written they are for the eye";
  // The colours come by colorIndex, and after a part that has none.
  Character by_index = test::load_text(
      skin_figure(in_skin(colored("plain")) +
                  in_skin(colored("a", "coordIndex='0 1 2 3' colorIndex='1 1 0 0'", rgb))));
  uvec3 t = by_index.parts[1].triangles[0];
  EXPECT_EQ(by_index.colors[t.x], vec4(0, 0, 1, 1));
  EXPECT_EQ(by_index.colors[t.z], vec4(1, 0, 0, 1));
}

TEST(VertexColors, ByFaceAndWithAlpha) {
  const std::string two = "coordIndex='0 1 2 -1 0 2 3 -1' colorPerVertex='false'";
  const std::string rgba = "<ColorRGBA color='1 0 0 1 0 0 1 0.25'/>";
  Character c = test::load_text(skin_figure(in_skin(colored("a", two, rgba))));
  ASSERT_EQ(c.parts[0].triangles.size(), 2u);
  EXPECT_EQ(c.positions.size(), 6u) << "corners of two colours are two vertices";
  for (int k = 0; k < 3; k++) {
    EXPECT_EQ(c.colors[c.parts[0].triangles[0][k]], vec4(1, 0, 0, 1));
    EXPECT_EQ(c.colors[c.parts[0].triangles[1][k]], vec4(0, 0, 1, 0.25f));
  }
  EXPECT_TRUE(c.appearances[0].clear_colors);
  Character turned = test::load_text(
      skin_figure(in_skin(colored("a", two + std::string(" colorIndex='1 0'"), rgba))));
  EXPECT_EQ(turned.colors[turned.parts[0].triangles[1].x], vec4(1, 0, 0, 1));
  Character few = test::load_text(
      skin_figure(in_skin(colored("a", "coordIndex='0 1 2 3'", "<Color color='1 0 0'/>"))));
  EXPECT_TRUE(few.colors.empty());
  EXPECT_TRUE(test::says(few, "too few colours"));
  Character glows = test::load_text(
      skin_figure(in_skin(colored("a", two, rgba, "<UnlitMaterial emissiveColor='1 1 0'/>"))));
  EXPECT_TRUE(glows.colors.empty());
  EXPECT_TRUE(test::says(glows, "UnlitMaterial"));
}

TEST(LeftOut, IsCountedByKindOnce) {
  Character c = test::load_text(skin_figure(
      in_skin(colored("a") +
              "<PointLight/><Shape><PointSet><Coordinate USE='p'/></PointSet></Shape>"),
      "<DirectionalLight/><PointLight/><Viewpoint/><TouchSensor DEF='t'/><TimeSensor DEF='s'/>"
      "<Shape><Box/></Shape><Transform><Shape><Box/></Shape></Transform><WorldInfo/>"
      "<ROUTE fromNode='t' fromField='touchTime' toNode='s' toField='startTime'/>"));
  EXPECT_TRUE(
      test::says(c, "1 DirectionalLight, 2 PointLight, 1 PointSet, 1 TouchSensor, 1 Viewpoint"));
  EXPECT_TRUE(test::says(c, "2 shapes stand beside the humanoid and are left out"));
  EXPECT_TRUE(test::says(c, "1 of 1 ROUTEs"));
  EXPECT_EQ(c.warnings.size(), 3u);
  EXPECT_TRUE(test::load_text(skin_figure(in_skin(colored("a")))).warnings.empty());
}

TEST(BvhOffsets, ThatAreZeroAreThoseOfTheFirstFrame) {
  auto file = [](const std::string& channels, const std::string& frames) {
    return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
           "JOINT Chest\n{\nOFFSET 0 0 0\nCHANNELS " +
           channels +
           "\nJOINT Head\n{\nOFFSET 0 0 0\n"
           "CHANNELS " +
           channels + "\nEnd Site\n{\nOFFSET 0 0 0\n}\n}\n}\n}\nMOTION\n" + frames;
  };
  const std::string six = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation";
  Character c = test::load_text(file(six,
                                     "Frames: 2\nFrame Time: 0.1\n"
                                     "0 100 0 0 60 0 0 0 0 0 110 5 0 0 0\n"
                                     "0 100 0 0 65 0 0 0 0 0 110 5 0 0 0\n"),
                                ".bvh");
  ASSERT_EQ(c.joints.size(), 3u);
  EXPECT_NEAR(c.joints[2].center.y - c.joints[0].center.y, 1.7f, 1e-5f) << "centimetres";
  EXPECT_NEAR(c.joints[2].center.z, 0.05f, 1e-5f);
  EXPECT_TRUE(test::says(c, "all OFFSETs are zero: bones are as long as the first frame"));
  MotionPose pose;
  eval_motion(c.motions[0], 0.1, false, pose);
  EXPECT_NEAR(pose.translations[1].y, 0.05f, 1e-5f);
  Character none =
      test::load_text(file("1 Zrotation", "Frames: 1\nFrame Time: 0.1\n0 0 0 10 10\n"), ".bvh");
  EXPECT_TRUE(test::says(none, "the skeleton has no size"));
}

}  // namespace
}  // namespace wellspring::test
