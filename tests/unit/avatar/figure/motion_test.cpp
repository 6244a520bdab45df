// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "avatar/body/body.h"
#include "avatar/figure/bone_surface.h"
#include "avatar/figure/retarget.h"
#include "avatar/figure/skin.h"
#include "base/load_error.h"
#include "gltf/animation.h"
#include "gltf/data.h"
#include "unit/avatar/figures.h"
#include "unit/avatar/load/gltf_person.h"

namespace wellspring::test {
namespace {

Motion one_track(TrackKind kind, TrackCurve curve, std::vector<float> times,
                 std::vector<float> values) {
  Motion motion;
  motion.duration = times.back();
  motion.joints.push_back({"humanoid_root", -1, vec3(0, 1, 0)});
  motion.displacers.push_back("smile");
  motion.tracks.push_back({kind, curve, 0, std::move(times), std::move(values), {}});
  return motion;
}

float weight_at(const Motion& motion, double time, bool loop) {
  MotionPose pose;
  eval_motion(motion, time, loop, pose);
  return pose.displacers[0];
}

TEST(Motion, TimeHoldsAtTheEndsOrGoesAround) {
  Motion motion = one_track(TrackKind::displacer, TrackCurve::linear, {0, 1, 4}, {0, 1, 0});
  EXPECT_FLOAT_EQ(weight_at(motion, 0.5, false), 0.5f);
  EXPECT_FLOAT_EQ(weight_at(motion, 2.5, false), 0.5f);
  EXPECT_FLOAT_EQ(weight_at(motion, -3, false), 0);
  EXPECT_FLOAT_EQ(weight_at(motion, 1e9, false), 0);
  EXPECT_FLOAT_EQ(weight_at(motion, 8.5, true), 0.5f);
  EXPECT_FLOAT_EQ(weight_at(motion, -3.5, true), 0.5f);
  EXPECT_FLOAT_EQ(weight_at(motion, NAN, true), 0);
  EXPECT_FLOAT_EQ(weight_at(motion, INFINITY, true), 0);
}

TEST(Motion, CurvesAreThoseOfGltf) {
  Motion step = one_track(TrackKind::displacer, TrackCurve::step, {0, 1, 2}, {3, 5, 7});
  EXPECT_FLOAT_EQ(weight_at(step, 0.99, false), 3);
  EXPECT_FLOAT_EQ(weight_at(step, 1.0, false), 5);
  // Hermite with tangents 0, out 2 and in -2: at the middle (a + b) / 2 + span (out - in) / 8.
  Motion cubic = one_track(TrackKind::displacer, TrackCurve::cubic, {0, 2}, {0, 1, 2, -2, 3, 0});
  EXPECT_NEAR(weight_at(cubic, 1, false), 2 + 2 * (2 + 2) / 8.0f, 1e-5f);
  Motion turn = one_track(TrackKind::rotation, TrackCurve::linear, {0, 1},
                          {0, 0, 0, 1, 0, -0.5f, 0, -0.8660254f});
  MotionPose pose;
  eval_motion(turn, 0.5, false, pose);
  // The other sign of the same turn: the short way all the same.
  EXPECT_NEAR(std::abs(dot(pose.rotations[0], glm::angleAxis(pi / 6, vec3(0, 1, 0)))), 1, 1e-5f);
}

// Five joints a side as motion capture draws them, arms out or hanging; `turn` for files lying on
// their side.
std::string bvh(bool t_pose, const std::string& frames, const char* unit = "1", bool crlf = false) {
  double u = std::atof(unit);
  auto offset = [&](double x, double y, double z) {
    char text[100];
    std::snprintf(text, sizeof text, "OFFSET %g %.6e %g\n", x * u, y * u, z * u);
    return std::string(text);
  };
  auto arm = [&](const char* side, double s) {
    std::string name = side;
    auto bone = [&](double length) {
      return t_pose ? offset(s * length, 0, 0) : offset(0, -length, 0);
    };
    return "JOINT " + name + "Shoulder {\n" + offset(s * 0.2, 0.4, 0) +
           "CHANNELS 3 Zrotation Xrotation Yrotation\nJOINT " + name + "Elbow\n{\n" + bone(0.3) +
           "CHANNELS 3 Zrotation Xrotation Yrotation\nJOINT " + name + "Wrist\n{\n" + bone(0.25) +
           "CHANNELS 3 zrotation XROTATION Yrotation\nEnd Site\n{\n" + bone(0.1) + "}\n}\n}\n}\n";
  };
  auto leg = [&](const char* side, double s) {
    std::string name = side;
    return "JOINT " + name + "Hip\n{\n" + offset(s * 0.1, 0, 0) +
           "CHANNELS 3 Zrotation Xrotation Yrotation\nJOINT " + name + "Knee\n{\n" +
           offset(0, -0.45, 0) + "CHANNELS 3 Zrotation Xrotation Yrotation\nJOINT " + name +
           "Ankle\n{\n" + offset(0, -0.45, 0) +
           "CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\n" + offset(0, -0.08, 0.15) +
           "}\n}\n}\n}\n";
  };
  std::string text =
      "HIERARCHY\nROOT Hips\n{\n" + offset(0, 0, 0) +
      "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\nJOINT Chest\n{\n" +
      offset(0, 0.2, 0) + "CHANNELS 3 Zrotation Xrotation Yrotation\nJOINT Head\n{\n" +
      offset(0, 0.5, 0) + "CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\n" +
      offset(0, 0.2, 0) + "}\n}\n" + arm("Left", 1) + arm("Right", -1) + "}\n" + leg("Left", 1) +
      leg("Right", -1) + "}\n" + frames;
  if (!crlf) return text;
  std::string windows;
  for (char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return windows;
}

// A frame of zeros but for some columns.
std::string frame(std::map<int, double> values) {
  std::string line;
  for (int c = 0; c < 6 + 14 * 3; c++) {
    char text[40];
    std::snprintf(text, sizeof text, "%s%g", c ? " " : "", values.count(c) ? values[c] : 0.0);
    line += text;
  }
  return line + "\n";
}
constexpr int left_shoulder = 6 + 2 * 3, left_elbow = left_shoulder + 3, left_hip = 6 + 8 * 3;

Character load_bvh(const std::string& text) { return test::load_text(text, ".bvh"); }

std::string one_frame(std::map<int, double> values) {
  return "MOTION\nFrames: 1\nFrame Time: .0333333\n" + frame(std::move(values));
}

vec3 bone_of(const Character& c, const Pose& pose, const char* from, const char* to) {
  vec3 a = eval_joint_frame(c, pose, find_joint(c, from)).center,
       b = eval_joint_frame(c, pose, find_joint(c, to)).center;
  return normalize(b - a);
}

Pose play(const Motion& motion, const Character& c, double time = 0, float weight = 1) {
  Pose pose = make_rest_pose(c);
  apply_motion(motion, make_retarget(motion, c), c, time, false, weight, pose);
  return pose;
}

TEST(Bvh, SkeletonIsNamedAndMeasuredInMetres) {
  for (const char* unit : {"1", "100", "39.37"}) {
    Character c =
        load_bvh(bvh(true, one_frame({{1, 0.98 * std::atof(unit)}}), unit, unit[0] == '3'));
    EXPECT_EQ(c.joints.size(), 15u);
    ASSERT_GE(find_joint(c, "l_elbow"), 0);
    EXPECT_NEAR(c.joints[size_t(find_joint(c, "l_elbow"))].center.x, 0.5f, 2e-3f);
    EXPECT_NEAR(c.joints[0].center.y, 0.98f, 5e-3f) << "stands on its feet";
    ASSERT_EQ(c.motions.size(), 1u);
    Pose pose = play(c.motions[0], c);
    EXPECT_LT(glm::length(eval_joint_frame(c, pose, 0).center - c.joints[0].center), 5e-3f);
  }
}

TEST(Bvh, ChannelsComposeInTheirOrder) {
  // Z, X, Y as listed: the arm's bone along +X.
  Character c = load_bvh(bvh(
      true, one_frame({{left_shoulder, 30}, {left_shoulder + 1, 40}, {left_shoulder + 2, 50}})));
  Pose pose = play(c.motions[0], c);
  quat turn = glm::angleAxis(pi / 6, vec3(0, 0, 1)) * glm::angleAxis(pi * 40 / 180, vec3(1, 0, 0)) *
              glm::angleAxis(pi * 50 / 180, vec3(0, 1, 0));
  EXPECT_LT(glm::length(bone_of(c, pose, "l_shoulder", "l_elbow") - turn * vec3(1, 0, 0)), 1e-4f);
}

TEST(Bvh, ASkeletonAloneHasBonesToLookAt) {
  Character c = load_bvh(bvh(true, one_frame({})));
  ASSERT_TRUE(c.parts.empty());
  add_bone_surface(c);
  ASSERT_EQ(c.parts.size(), 1u);
  EXPECT_EQ(c.parts[0].triangles.size(), 8 * (14 + 5u)) << "a bone between joints, and five ends";
  EXPECT_EQ(c.first_weight.size(), c.positions.size() + 1);
  for (uvec3 t : c.parts[0].triangles) {  // outside is outside
    vec3 a = c.positions[t.x], n = c.normals[t.x];
    EXPECT_NEAR(dot(n, normalize(cross(c.positions[t.y] - a, c.positions[t.z] - a))), 1, 1e-4f);
  }
  Character person = test::load_text(make_person().gltf(), ".gltf");
  size_t vertices = person.positions.size();
  add_bone_surface(person);
  EXPECT_EQ(person.positions.size(), vertices);
}

TEST(Bvh, BrokenFilesNameTheLine) {
  auto refusal = [](const std::string& text) {
    try {
      load_bvh(text);
    } catch (const LoadError& error) {
      return error.where + ": " + error.what_;
    }
    return std::string();
  };
  std::string good = bvh(true, one_frame({}));
  EXPECT_EQ(refusal(good), "");
  EXPECT_NE(refusal("HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\nCHANNELS 1 Wrotation\n}\n")
                .find("line 5: unknown channel"),
            std::string::npos);
  EXPECT_NE(refusal("HIERARCHY\nROOT A\n{\nOFFSET 0 x 0\n}\n").find("line 4: 'x' is no number"),
            std::string::npos);
  EXPECT_NE(refusal("HIERARCHY\nROOT A\n{\nOFFSET 0 nan 0\n}\n").find("line 4"), std::string::npos);
  EXPECT_NE(refusal("HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\n}\nROOT B\n{\nOFFSET 0 0 0\n}\n")
                .find("second root"),
            std::string::npos);
  EXPECT_NE(refusal(bvh(true, "MOTION\nFrames: 1000000000\nFrame Time: 0.1\n" + frame({})))
                .find("ends in frame 1 of 1000000000"),
            std::string::npos);
  EXPECT_NE(refusal(bvh(true, "MOTION\nFrames: -3\nFrame Time: 0.1\n")).find("frames"),
            std::string::npos);
  std::string deep = "HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\n";
  for (int i = 0; i < 100000; i++) deep += "JOINT B\n{\nOFFSET 0 0 0\n";
  EXPECT_NE(refusal(deep).find("nested deeper"), std::string::npos);
  std::string wide = "HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\n";
  for (int i = 0; i < 1000000; i++) wide += "JOINT B{OFFSET 0 0 0}";
  EXPECT_NE(refusal(wide).find("more than 4096 joints"), std::string::npos);
  for (size_t length = 9; length < good.size(); length += 41)
    EXPECT_THROW(
        {
          Character c = load_bvh(good.substr(0, length));
          if (c.motions.empty()) throw LoadError("", "", "cut before the motion");
        },
        LoadError)
        << length;
}

TEST(Retarget, LimbsLieInSpaceAsInTheRecordingWhateverTheRestPoses) {
  // The same figure of arms: hanging, and stretched out by the recording.
  Character person = test::load_text(make_person().gltf(), ".gltf");  // T-pose
  for (bool t_pose : {true, false}) {
    Character recorded = load_bvh(bvh(t_pose, one_frame({{left_shoulder, -25},
                                                         {left_shoulder + 1, 15},
                                                         {left_elbow, 40},
                                                         {left_hip, 20},
                                                         {left_hip + 1, -35}})));
    Pose theirs = play(recorded.motions[0], recorded), ours = play(recorded.motions[0], person);
    for (auto [from, to] :
         {std::pair("l_shoulder", "l_elbow"), std::pair("l_elbow", "l_radiocarpal"),
          std::pair("r_shoulder", "r_elbow"), std::pair("l_hip", "l_knee"),
          std::pair("l_knee", "l_talocrural")})
      EXPECT_LT(glm::length(bone_of(person, ours, from, to) - bone_of(recorded, theirs, from, to)),
                2e-3f)
          << from << t_pose;
  }
}

TEST(Retarget, HipsGoAsFarAsTheFigureIsTall) {
  Character person = test::load_text(make_person().gltf(), ".gltf");
  Character recorded = load_bvh(bvh(true, one_frame({{0, 50}, {1, 98 - 20}, {2, 30}}), "100"));
  Pose pose = play(recorded.motions[0], person);
  vec3 moved = eval_joint_frame(person, pose, 0).center - person.joints[0].center;
  float scale = (0.95f - 0.09f) / (0.98f - 0.08f);  // between hips and ankles
  EXPECT_NEAR(moved.x, 0.5f * scale, 5e-3f);
  EXPECT_NEAR(moved.y, -0.2f * scale, 5e-3f);
  EXPECT_NEAR(moved.z, 0.3f * scale, 5e-3f);
}

TEST(Retarget, OneSpineJointBecomesMany) {
  Character person = test::load_text(make_person().gltf(), ".gltf");  // vl5 and vt10
  Character recorded = load_bvh(bvh(true, one_frame({{7, 40}})));     // Chest bends forward
  Pose pose = play(recorded.motions[0], person);
  quat half = glm::angleAxis(20 * pi / 180, vec3(1, 0, 0));
  EXPECT_GT(std::abs(dot(pose.rotations[size_t(find_joint(person, "vl5"))], half)), 1 - 1e-5f);
  EXPECT_GT(std::abs(dot(pose.rotations[size_t(find_joint(person, "vt10"))], half)), 1 - 1e-5f);
}

TEST(Retarget, BlendsOverAPoseAndLeavesAloneWhatItDoesNotMove) {
  Character person = test::load_text(make_person().gltf(), ".gltf");
  Motion wave;
  for (const Joint& joint : person.joints)
    wave.joints.push_back({joint.name, joint.parent, joint.center});
  int elbow = find_joint(person, "r_elbow"), knee = find_joint(person, "r_knee");
  quat bent = glm::angleAxis(1.0f, vec3(0, 1, 0));
  wave.tracks.push_back(
      {TrackKind::rotation, TrackCurve::linear, elbow, {0}, {bent.x, bent.y, bent.z, bent.w}, {}});
  Retarget retarget = make_retarget(wave, person);
  EXPECT_TRUE(retarget.same);
  Pose pose = make_rest_pose(person);
  pose.rotations[size_t(knee)] = glm::angleAxis(0.4f, vec3(1, 0, 0));
  Pose before = pose;
  apply_motion(wave, retarget, person, 0, true, 0, pose);
  EXPECT_EQ(pose.rotations, before.rotations);
  apply_motion(wave, retarget, person, 0, true, 0.5f, pose);
  EXPECT_NEAR(glm::angle(pose.rotations[size_t(elbow)]), 0.5f, 1e-4f);
  EXPECT_EQ(pose.rotations[size_t(knee)], before.rotations[size_t(knee)]);
  Motion other = wave;
  other.joints[size_t(elbow)].name = "tentacle";
  EXPECT_FALSE(make_retarget(other, person).fits);
}

// The figure moved by its Motion stands where glTF's own rules put its vertices.
TEST(GltfMotion, AnimationsAreShownAsTheFileMeansThem) {
  test::PersonOptions options;
  options.odd_axes = true;
  options.posed["rightUpperArm"] = glm::angleAxis(0.5f, vec3(0, 0, 1));
  Asset asset = make_person(options);
  auto key = [&](int node, const char* path, const std::vector<float>& values, const char* type,
                 int width) {
    json& animation = asset.root["animations"][0];
    animation["name"] = "dance";
    animation["samplers"].push_back({{"input", asset.add_floats("SCALAR", 1, {0, 1, 2})},
                                     {"output", asset.add_floats(type, width, values)}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  };
  std::vector<float> turns;
  for (float angle : {0.2f, 0.9f, -0.4f}) {
    quat q = glm::angleAxis(angle, normalize(vec3(1, 2, -1)));
    turns.insert(turns.end(), {q.x, q.y, q.z, q.w});
  }
  key(test::person_bone("leftUpperArm"), "rotation", turns, "VEC4", 4);
  key(test::person_bone("spine"), "rotation", turns, "VEC4", 4);
  key(0, "translation", {0, 1, 0, 0.3f, 1.2f, 0.1f, 0, 0.9f, 0}, "VEC3", 3);
  key(test::person_bone("rightLowerLeg"), "scale", {1, 1, 1, 1.5f, 0.5f, 2, 1, 1, 1}, "VEC3", 3);
  test::TemporaryFile on_disk(asset.glb(), ".glb");
  Character c = load_character(on_disk.path());
  ASSERT_EQ(c.motions.size(), 1u);
  EXPECT_EQ(c.motions[0].name, "dance");
  EXPECT_FLOAT_EQ(c.motions[0].duration, 2);

  gltf::File file = gltf::load_gltf(on_disk.path(), "");
  auto binds = gltf::read_floats(file, file.root["skins"][0]["inverseBindMatrices"].get<size_t>());
  auto points = gltf::read_floats(
      file, file.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<size_t>());
  for (double time : {0.25, 1.0, 1.6}) {
    Pose pose = make_rest_pose(c);
    for (size_t j = 0; j < c.joints.size(); j++) pose.rotations[j] = c.joints[j].rest_rotation;
    apply_motion(c.motions[0], make_retarget(c.motions[0], c), c, time, false, 1, pose);
    SkinScratch scratch;
    std::vector<vec3> positions, normals;
    skin(c, pose, mat4(1), scratch, positions, normals);
    std::vector<gltf::Node> nodes = gltf::make_pose(file, time);
    for (size_t bone = 0; bone < 17; bone++) {
      dmat4 bind(1);
      for (size_t i = 0; i < 16; i++)
        bind[int(i / 4)][int(i % 4)] = double((*binds)[bone * 16 + i]);
      dmat4 m = nodes[bone].global * bind;
      for (size_t corner = 0; corner < 8; corner++) {
        const float* p = points->data() + (bone * 8 + corner) * 3;
        vec3 wanted(m * dvec4(double(p[0]), double(p[1]), double(p[2]), 1));
        float nearest = 1e9f;
        for (vec3 q : positions) nearest = std::min(nearest, glm::length(q - wanted));
        EXPECT_LT(nearest, 1e-3f) << "bone " << bone << " at " << time;
      }
    }
  }
}

TEST(X3dMotion, HAnimMotionAsFilesWriteIt) {
  Character c = test::load_text(test::small_skin("", "").replace(
      test::small_skin("", "").find("</HAnimHumanoid>"), 0,
      "<HAnimMotion name='sway' containerField='motions' enabled='false' frameDuration='0.5' "
      "loop='true'"
      " joints='HumanoidRoot IGNORED vl5 tail' channels='6 Xposition Yposition Zposition Zrotation "
      "Xrotation Yrotation"
      " 1 Xrotation 3 Zrotation Xrotation Yrotation 1 Xrotation'"
      " values='0 0 0 0 0 0 7 0 0 0 1  0.5 0 0 90 0 0 7 90 90 0 2  1 2 3'/>"));
  ASSERT_EQ(c.motions.size(), 1u);
  const Motion& motion = c.motions[0];
  EXPECT_TRUE(motion.loop);
  EXPECT_FLOAT_EQ(motion.duration, 0.5f);
  MotionPose pose;
  eval_motion(motion, 0.5, false, pose);
  EXPECT_GT(dot(pose.rotations[0], glm::angleAxis(pi / 2, vec3(0, 0, 1))), 1 - 1e-5f);
  quat zx = glm::angleAxis(pi / 2, vec3(0, 0, 1)) * glm::angleAxis(pi / 2, vec3(1, 0, 0));
  EXPECT_GT(std::abs(dot(pose.rotations[1], zx)), 1 - 1e-5f);
  EXPECT_NEAR(pose.translations[0].x, 0.5f, 1e-5f);
  bool tail = false, whole = false;
  for (const std::string& w : c.warnings) {
    tail = tail || w.find("'tail'") != std::string::npos;
    whole = whole || w.find("not whole") != std::string::npos;
  }
  EXPECT_TRUE(tail);
  EXPECT_TRUE(whole);
}

TEST(X3dMotion, RoutesFromTimersToJointsInEveryEncoding) {
  std::string xml = test::x3d(R"(
<HAnimHumanoid name='R'><HAnimJoint DEF='root' containerField='skeleton' name='humanoid_root'>
 <HAnimJoint DEF='V' name='vl5' center='0 1 0'><HAnimDisplacer DEF='D' name='rise' containerField='displacers'/></HAnimJoint></HAnimJoint></HAnimHumanoid>
<TimeSensor DEF='Clock' cycleInterval='4' loop='true'/><OrientationInterpolator DEF='O' key='0 0.5 1' keyValue='0 0 0 0 0 1 0 1 0 1 0 0'/>
<PositionInterpolator DEF='P' key='0 1' keyValue='0 0 0 0 2 0'/><ScalarInterpolator DEF='S' key='0 1' keyValue='0 1'/>
<ROUTE fromNode='Clock' fromField='fraction_changed' toNode='O' toField='set_fraction'/><ROUTE fromNode='O' fromField='value_changed' toNode='V' toField='rotation'/>
<ROUTE fromNode='Clock' fromField='fraction_changed' toNode='P' toField='set_fraction'/><ROUTE fromNode='P' fromField='value_changed' toNode='root' toField='set_translation'/>
<ROUTE fromNode='Clock' fromField='fraction_changed' toNode='S' toField='set_fraction'/><ROUTE fromNode='S' fromField='value_changed' toNode='D' toField='set_weight'/>
<ROUTE fromNode='Nobody' fromField='x' toNode='V' toField='y'/>)");
  std::string classic = R"(#X3D V3.3 utf8
DEF H HAnimHumanoid { name "R" skeleton [ DEF root HAnimJoint { name "humanoid_root" children [ DEF V HAnimJoint { name "vl5" center 0 1 0
 displacers [ DEF D HAnimDisplacer { name "rise" } ] } ] } ] }
DEF Clock TimeSensor { cycleInterval 4 loop TRUE }
DEF O OrientationInterpolator { key [0 0.5 1] keyValue [0 0 0 0, 0 1 0 1, 0 1 0 0] }
DEF P PositionInterpolator { key [0 1] keyValue [0 0 0, 0 2 0] }
DEF S ScalarInterpolator { key [0 1] keyValue [0 1] }
ROUTE Clock.fraction_changed TO O.set_fraction
ROUTE O.value_changed TO V.set_rotation
ROUTE Clock.fraction_changed TO P.set_fraction
ROUTE P.value_changed TO root.translation
ROUTE Clock.fraction TO S.fraction
ROUTE S.value_changed TO D.weight
)";
  std::string many = xml;
  std::string once =
      "<ROUTE fromNode='Clock' fromField='fraction_changed' toNode='O' toField='set_fraction'/>"
      "<ROUTE fromNode='O' fromField='value_changed' toNode='V' toField='rotation'/>";
  std::string thousands;
  for (int i = 0; i < 30'000; i++) thousands += once;
  many.insert(many.find("<ROUTE"), thousands);
  for (const Character& c :
       {test::load_text(xml), test::load_text(many), test::load_text(classic, ".x3dv")}) {
    ASSERT_EQ(c.motions.size(), 1u);
    EXPECT_EQ(c.motions[0].name, "Clock");
    EXPECT_EQ(c.motions[0].tracks.size(), 3u);
    MotionPose pose;
    eval_motion(c.motions[0], 1, true, pose);
    EXPECT_NEAR(glm::angle(pose.rotations[1]), 0.5f, 1e-4f);
    EXPECT_NEAR(pose.translations[0].y, 0.5f, 1e-5f);
    EXPECT_NEAR(pose.displacers[0], 0.25f, 1e-5f);
  }
}

}  // namespace
}  // namespace wellspring::test
