// SPDX-License-Identifier: Apache-2.0
// One figure in every encoding must be one figure.
#include <gtest/gtest.h>

#include <filesystem>

#include "base/load_error.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

const std::string in_xml = test::x3d(R"(
<Transform scale='2 2 2'><HAnimHumanoid DEF='H' name='Twin' loa='0'>
  <HAnimJoint DEF='R' containerField='skeleton' name='HumanoidRoot' center='0 1 0' skinCoordIndex='0 1 2' skinCoordWeight='1 0.5 1'
      llimit='-1 -1 -1' ulimit='1 1 1'>
    <HAnimJoint DEF='V' name='vl5' center='0 1.1 -1.5e-2' rotation='0 1 0 0.5' skinCoordIndex='1' skinCoordWeight='0.5'>
      <HAnimDisplacer name='rise' coordIndex='1' displacements='0 0.1 0'/>
      <HAnimSegment name='l5'><Transform translation='0 1 0'><Shape DEF='Ball'><Appearance><Material diffuseColor='1 0.5 0'/></Appearance>
        <Sphere radius='0.1'/></Shape></Transform><Shape USE='Ball'/></HAnimSegment>
    </HAnimJoint>
  </HAnimJoint>
  <HAnimJoint USE='R' containerField='joints'/><HAnimJoint USE='V' containerField='joints'/>
  <Shape containerField='skin'><IndexedFaceSet solid='false' coordIndex='0 1 2 -1'><Coordinate DEF='P' point='0 0 0 1 0 0 0 1 0'/>
  </IndexedFaceSet></Shape>
  <Coordinate USE='P' containerField='skinCoord'/>
  <HAnimMotion name='wave "hello"' containerField='motions'/>
</HAnimHumanoid></Transform>)");

const std::string in_classic = R"(#X3D V4.0 utf8
PROFILE Immersive
COMPONENT HAnim : 1
META "title" "a # is no comment in here"
PROTO Unused [ exposedField SFVec3f center 0 0 0 ] { Transform { center IS center children [ Shape { } ] } }
Transform { scale 2, 2, 2 children [ # a comment }
  DEF H HAnimHumanoid { name "Twin" loa 0
    skeleton [ DEF R HAnimJoint { name "HumanoidRoot" center 0 1 0 skinCoordIndex [0,1,2] skinCoordWeight [ 1 0.5 1 ]
      llimit [-1 -1 -1] ulimit [ 1 1 1 ]
      children [ DEF V HAnimJoint { name "vl5" center 0 1.1 -1.5e-2 rotation 0 1 0 0.5 skinCoordIndex 1 skinCoordWeight [0.5]
        displacers [ HAnimDisplacer { name "rise" coordIndex [1] displacements [ 0 0.1 0 ] } ]
        children HAnimSegment { name "l5" children [
          Transform { translation 0 1 0 children DEF Ball Shape { appearance Appearance { material Material { diffuseColor 1 0.5 0 } }
            geometry Sphere { radius 0.1 } } }
          USE Ball ] } } ] } ]
    joints [ USE R USE V ]
    skin [ Shape { geometry IndexedFaceSet { solid FALSE coordIndex [0 1 2 -1] coord DEF P Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } } } ]
    skinCoord USE P
    motions [ HAnimMotion { name "wave \"hello\"" } ]
  } ] }
ROUTE R.rotation_changed TO V.set_rotation
)";

const std::string in_json =
    R"({ "X3D": { "encoding": "UTF-8", "@profile": "Immersive", "head": { "meta": [ { "@name": "title", "@content": "x" } ] },
 "Scene": { "-children": [ { "#comment": "hello" }, { "Transform": { "@scale": [2, 2, 2], "-children": [
  { "HAnimHumanoid": { "@DEF": "H", "@name": "Twin", "@loa": 0,
    "-skeleton": [ { "HAnimJoint": { "@DEF": "R", "@name": "HumanoidRoot", "@center": [0, 1, 0], "@skinCoordIndex": [0, 1, 2],
      "@skinCoordWeight": [1, 0.5, 1], "@llimit": [-1, -1, -1], "@ulimit": [1, 1, 1], "-children": [
      { "HAnimJoint": { "@DEF": "V", "@name": "vl5", "@center": [0, 1.1, -0.015], "@rotation": [0, 1, 0, 0.5], "@skinCoordIndex": [1],
        "@skinCoordWeight": [0.5],
        "-displacers": [ { "HAnimDisplacer": { "@name": "rise", "@coordIndex": [1], "@displacements": [0, 0.1, 0] } } ],
        "-children": [ { "HAnimSegment": { "@name": "l5", "-children": [
          { "Transform": { "@translation": [0, 1, 0], "-children": [ { "Shape": { "@DEF": "Ball",
            "-appearance": { "Appearance": { "-material": { "Material": { "@diffuseColor": [1, 0.5, 0] } } } },
            "-geometry": { "Sphere": { "@radius": 0.1 } } } } ] } },
          { "Shape": { "@USE": "Ball" } } ] } } ] } } ] } } ],
    "-joints": [ { "HAnimJoint": { "@USE": "R" } }, { "HAnimJoint": { "@USE": "V" } } ],
    "-skin": [ { "Shape": { "-geometry": { "IndexedFaceSet": { "@solid": false, "@coordIndex": [0, 1, 2, -1],
      "-coord": { "Coordinate": { "@DEF": "P", "@point": [0, 0, 0, 1, 0, 0, 0, 1, 0] } } } } } } ],
    "-skinCoord": { "Coordinate": { "@USE": "P" } },
    "-motions": [ { "HAnimMotion": { "@name": "wave \"hello\"" } } ] } } ] } } ] } } })";

void expect_same(const Character& a, const Character& b, const char* what) {
  SCOPED_TRACE(what);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.loa, b.loa);
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (size_t j = 0; j < a.joints.size(); j++) {
    EXPECT_EQ(a.joints[j].name, b.joints[j].name);
    EXPECT_EQ(a.joints[j].parent, b.joints[j].parent);
    EXPECT_EQ(a.joints[j].center, b.joints[j].center);
    EXPECT_EQ(a.joints[j].rest_rotation, b.joints[j].rest_rotation);
    EXPECT_EQ(a.joints[j].limits, b.joints[j].limits);
  }
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.first_weight, b.first_weight);
  ASSERT_EQ(a.weights.size(), b.weights.size());
  for (size_t k = 0; k < a.weights.size(); k++) {
    EXPECT_EQ(a.weights[k].joint, b.weights[k].joint);
    EXPECT_EQ(a.weights[k].weight, b.weights[k].weight);
  }
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (size_t p = 0; p < a.parts.size(); p++) EXPECT_EQ(a.parts[p].triangles, b.parts[p].triangles);
  ASSERT_EQ(a.appearances.size(), b.appearances.size());
  for (size_t l = 0; l < a.appearances.size(); l++) {
    EXPECT_EQ(a.appearances[l].base_color, b.appearances[l].base_color);
    EXPECT_EQ(a.appearances[l].double_sided, b.appearances[l].double_sided);
  }
  ASSERT_EQ(a.displacers.size(), b.displacers.size());
  for (size_t d = 0; d < a.displacers.size(); d++) {
    EXPECT_EQ(a.displacers[d].name, b.displacers[d].name);
    EXPECT_EQ(a.displacers[d].vertices, b.displacers[d].vertices);
    EXPECT_EQ(a.displacers[d].displacements, b.displacers[d].displacements);
  }
  EXPECT_EQ(a.segments.size(), b.segments.size());
}

TEST(Encodings, OneFigureThreeWays) {
  Character xml = load_text(in_xml), classic = load_text(in_classic, ".x3dv"),
            json = load_text(in_json, ".json");
  ASSERT_EQ(xml.joints.size(), 2u);
  EXPECT_EQ(xml.joints[1].center, vec3(0, 2.2f, -0.03f));
  EXPECT_EQ(xml.parts.size(), 3u);
  EXPECT_EQ(xml.displacers.size(), 1u);
  EXPECT_EQ(xml.joints[0].limits.size(), 3u);
  expect_same(xml, classic, "ClassicVRML");
  expect_same(xml, json, "JSON");
  for (const Character* c : {&xml, &classic, &json}) {
    ASSERT_EQ(c->motions.size(), 1u);
    EXPECT_EQ(c->motions[0].name, "wave \"hello\"");
  }
}

TEST(Encodings, Vrml97WithPrototypes) {
  Character c = load_text(R"(#VRML V2.0 utf8
PROTO Joint [ exposedField SFVec3f center 0 0 0 exposedField MFNode children [] exposedField SFString name "" ]
{ Transform { center IS center children IS children } }
PROTO Segment [ exposedField MFNode children [] field SFString name "" ] { Group { children IS children } }
EXTERNPROTO Humanoid [ field SFString name ] [ "http://example.com/humanoid.wrl#Humanoid" ]
DEF Human Humanoid { name "Old one" version "1.1"
  humanoidBody [ DEF hanim_HumanoidRoot Joint { name "HumanoidRoot" center 0 0.9 0
    children [ DEF hanim_sacrum Segment { name "sacrum" children [ Shape { geometry Box { size .1 .1 .1 } } ] }
               DEF hanim_l_wrist Joint { name "l_wrist" center .2 .8 0 } ] } ]
  joints [ USE hanim_HumanoidRoot, USE hanim_l_wrist ]
  segments [ USE hanim_sacrum ] }
)",
                          ".wrl");
  EXPECT_EQ(c.name, "Old one");
  ASSERT_EQ(c.joints.size(), 2u);
  EXPECT_EQ(c.joints[1].name, "l_radiocarpal");
  EXPECT_EQ(c.segments.size(), 1u);
  EXPECT_EQ(c.parts.size(), 1u);
}

TEST(Encodings, BrokenClassicNamesTheLine) {
  auto refusal = [](const std::string& text) {
    try {
      load_text(text, ".x3dv");
    } catch (const LoadError& error) {
      return error.where + ": " + error.what_;
    }
    return std::string();
  };
  EXPECT_NE(refusal("#X3D V3.0 utf8\nGroup {\n children [\n").find("line 4"), std::string::npos);
  EXPECT_NE(refusal("#X3D V3.0 utf8\nGroup { children } }").find("line 2"), std::string::npos);
  EXPECT_NE(refusal("#X3D V3.0 utf8\nMETA \"a").find("no end"), std::string::npos);
  EXPECT_NE(refusal("#VRML V1.0 ascii\n").find("VRML 1"), std::string::npos);
  std::string deep = "#X3D V3.0 utf8\n";
  for (int i = 0; i < 100000; i++) deep += "Group { children [ ";
  EXPECT_NE(refusal(deep).find("deeper"), std::string::npos);
  EXPECT_NE(refusal("#X3D V3.0 utf8\nPROTO X [ " + std::string(100000, '[')).find("never closed"),
            std::string::npos);
}

TEST(Encodings, BrokenJsonIsRefused) {
  for (const std::string& text :
       {std::string("{"), std::string("{}"), std::string("{\"X3D\":[]}"),
        std::string("{\"X3D\":{\"Scene\":3}}"), "{\"X3D\":" + std::string(100000, '['),
        std::string("{\"X3D\":{\"Scene\":{\"-children\":[{\"HAnimHumanoid\":{"
                    "\"-skeleton\":[{\"HAnimJoint\":{\"@center\":[[1],2,3]}}]}}]}}}")})
    EXPECT_THROW(load_text(text, ".json"), LoadError) << text.substr(0, 60);
}

TEST(Encodings, EveryTruncationAndFlippedByte) {
  for (const auto& [text, ending] :
       {std::pair(in_classic, ".x3dv"), std::pair(in_json, ".json"), std::pair(in_xml, ".x3d")}) {
    test::TemporaryFile file("", ending);
    for (size_t at = 0; at < text.size(); at += 7) {
      for (bool cut : {true, false}) {
        std::string broken = cut ? text.substr(0, at) : text;
        if (!cut) broken[at] = char(broken[at] ^ 0x09);
        std::ofstream(file.path(), std::ios::binary | std::ios::trunc) << broken;
        try {
          Character c = load_character(file.path());
          EXPECT_FALSE(c.joints.empty());
        } catch (const LoadError&) {}
      }
    }
  }
}

TEST(Encodings, JoeIsTheSameInXmlAndClassic) {
  std::filesystem::path kit =
      std::filesystem::path(WELLSPRING_DATA) / "2_x3d_hanim/hanim_utility_kit";
  if (!std::filesystem::exists(kit)) GTEST_SKIP() << "no H-Anim files at " << kit;
  for (const char* name : {"JoeHAnimKick1a", "JoeDemo5JoeSkin5"}) {
    Character xml = load_character((kit / (std::string(name) + ".x3d")).string());
    Character classic = load_character((kit / (std::string(name) + ".x3dv")).string());
    ASSERT_EQ(xml.joints.size(), classic.joints.size());
    for (size_t j = 0; j < xml.joints.size(); j++) {
      EXPECT_EQ(xml.joints[j].name, classic.joints[j].name);
      EXPECT_EQ(xml.joints[j].parent, classic.joints[j].parent);
      EXPECT_LT(glm::length(xml.joints[j].center - classic.joints[j].center), 1e-4f);
    }
    EXPECT_EQ(xml.positions.size(), classic.positions.size());
    EXPECT_EQ(xml.weights.size(), classic.weights.size());
  }
}

}  // namespace
}  // namespace wellspring::test
