// SPDX-License-Identifier: Apache-2.0
// Files people really made. Skipped where they are not at hand.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "avatar/body/body.h"
#include "avatar/figure/hanim_names.h"
#include "avatar/figure/retarget.h"
#include "avatar/figure/skin.h"
#include "base/load_error.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;
const fs::path corpus = fs::path(WELLSPRING_DATA) / "2_x3d_hanim";

#define NEEDS_CORPUS() \
  if (!fs::exists(corpus)) GTEST_SKIP() << "no H-Anim files at " << corpus

Character load(const char* file) { return load_character((corpus / file).string()); }

TEST(Corpus, EveryFileLoadsOrIsRefusedWithAReason) {
  NEEDS_CORPUS();
  int figures = 0, refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(corpus)) {
    if (!entry.is_regular_file()) continue;
    try {
      Character c = load_character(entry.path().string());
      figures++;
      ASSERT_FALSE(c.joints.empty());
      EXPECT_EQ(c.first_weight.size(), c.positions.size() + 1);
      EXPECT_EQ(c.normals.size(), c.positions.size());
      for (size_t j = 0; j < c.joints.size(); j++) EXPECT_LT(c.joints[j].parent, int(j));
      for (vec3 n : c.normals) EXPECT_NEAR(glm::length(n), 1, 1e-3f);
      std::set<std::string> names;
      for (const Joint& joint : c.joints)
        EXPECT_TRUE(names.insert(joint.name).second) << entry.path() << joint.name;
    } catch (const LoadError& error) {
      refused++;
      EXPECT_FALSE(error.what_.empty());
    }
  }
  EXPECT_GE(figures, 16);
  EXPECT_GT(refused, 10);
}

// VRM models of exporters and of hand-made corner cases, skins of glTF's sample models.
TEST(Corpus, VrmAndSkinsLoadOrAreRefusedWithAReason) {
  int figures = 0, persons = 0;
  std::vector<std::string> refused;
  for (const char* set : {"3_vrm", "1_gltf/khronos", "1_gltf/ozz", "1_gltf/assimp/simple_skin"}) {
    fs::path folder = fs::path(WELLSPRING_DATA) / set;
    if (!fs::exists(folder)) GTEST_SKIP() << "no models at " << folder;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      std::string ending = entry.path().extension().string();
      if (ending != ".vrm" && ending != ".vrma" && ending != ".glb" && ending != ".gltf") continue;
      SCOPED_TRACE(entry.path());
      try {
        Character c = load_character(entry.path().string());
        figures++;
        ASSERT_FALSE(c.joints.empty());
        EXPECT_EQ(c.first_weight.size(), c.positions.size() + 1);
        for (vec3 n : c.normals) ASSERT_NEAR(glm::length(n), 1, 1e-3f);
        bool person = find_joint(c, "l_hip") >= 0 && find_joint(c, "l_shoulder") >= 0;
        persons += person;
        if (person && find_joint(c, "l_knee") >= 0) {
          auto at = [&](const char* name) { return c.joints[size_t(find_joint(c, name))].center; };
          EXPECT_GT(at("l_shoulder").x, at("r_shoulder").x) << "faces the visitor";
          EXPECT_GT(at("l_shoulder").y, at("l_knee").y) << "stands";
        }
        if (ending == ".vrm") EXPECT_TRUE(person);
      } catch (const LoadError& error) {
        EXPECT_FALSE(error.what_.empty());
        refused.push_back(entry.path().filename().string());
        EXPECT_NE(ending, ".vrm") << error.what();
      }
    }
  }
  EXPECT_GE(persons, 55);
  EXPECT_GE(figures, 60);
  EXPECT_GE(refused.size(), 3u) << "cubes are no figures";
}

TEST(Corpus, RecordingsMoveAnyFigure) {
  NEEDS_CORPUS();
  fs::path data(WELLSPRING_DATA);
  Character jin = load("web3d_pythonSAI/KoreanCharacter01Jin.x3d");
  std::string missing;
  for (const char* file : {"4_bvh/assimp/01_01.bvh", "4_bvh/bvh_python/test_mocapbank.bvh",
                           "3_vrm/three_vrm/packages/vrm-viewer/idle_loop.vrma",
                           "1_gltf/khronos/CesiumMan/glTF-Binary/CesiumMan.glb",
                           "2_x3d_hanim/web3d_pythonSAI/KoreanCharacterMotionAnnexD01Jin.x3d",
                           "2_x3d_hanim/web3d_pythonSAI/JoeKick.x3d"}) {
    if (!fs::exists(data / file)) {
      missing += std::string(" ") + file;
      continue;
    }
    SCOPED_TRACE(file);
    Character recorded = load_character((data / file).string());
    ASSERT_FALSE(recorded.motions.empty());
    const Motion& motion = recorded.motions[0];
    Retarget retarget = make_retarget(motion, jin);
    EXPECT_TRUE(retarget.fits);
    for (int i = 0; i <= 8; i++) {
      Pose pose = make_rest_pose(jin);
      apply_motion(motion, retarget, jin, double(motion.duration) * i / 8, false, 1, pose);
      for (quat q : pose.rotations) EXPECT_NEAR(glm::length(q), 1, 1e-3f);
      // Whatever the recording does, the hips keep their distance to a floor under them.
      EXPECT_GT(eval_joint_frame(jin, pose, 0).center.y, 0.2f);
      EXPECT_LT(eval_joint_frame(jin, pose, 0).center.y, 1.6f);
    }
  }
  Character walk = load_character((data / "4_bvh/assimp/01_01.bvh").string());
  EXPECT_NEAR(walk.motions[0].duration, 22.9f, 0.1f);
  EXPECT_GE(find_joint(walk, "l_carpometacarpal_1"), 0) << "LThumb";
  if (!missing.empty()) GTEST_SKIP() << "not all recordings are here:" << missing;
}

TEST(Corpus, StandardSkeletonsHaveTheirLevelOfArticulation) {
  NEEDS_CORPUS();
  EXPECT_EQ(load("web3d_pythonSAI/Humanoid1.x3d").loa, 1);
  EXPECT_EQ(load("web3d_pythonSAI/Humanoid2.x3d").loa, 2);
  EXPECT_EQ(load("web3d_pythonSAI/Humanoid3.x3d").loa, 3);
  Character four = load("web3d_pythonSAI/Humanoid4.x3d");
  EXPECT_EQ(four.loa, 4);
  EXPECT_EQ(four.joints.size(), 146u);
  EXPECT_EQ(four.segments.size(), 119u);
  for (const Joint& joint : four.joints) EXPECT_GE(hanim_joint_level(joint.name), 0) << joint.name;
  auto parent = [&](const char* name) {
    return four.joints[size_t(four.joints[size_t(find_joint(four, name))].parent)].name;
  };
  EXPECT_EQ(parent("skullbase"), "vc1");
  EXPECT_EQ(parent("l_shoulder"), "l_acromioclavicular");
  EXPECT_EQ(parent("r_carpometacarpal_5"), "r_midcarpal_4_5");
  bool misplaced = false;
  for (const std::string& w : four.warnings)
    misplaced = misplaced || w.find("l_eyeball_joint") != std::string::npos;
  EXPECT_TRUE(misplaced);
}

TEST(Corpus, JinIsASegmentedFigureOfHumanSize) {
  NEEDS_CORPUS();
  Character jin = load("web3d_pythonSAI/KoreanCharacter01Jin.x3d");
  EXPECT_EQ(jin.loa, 1);
  EXPECT_EQ(jin.joints.size(), 18u);
  EXPECT_EQ(jin.segments.size(), 18u);
  EXPECT_EQ(jin.parts.size(), 18u);
  float high = 0;
  for (vec3 p : jin.positions) high = std::max(high, p.y);
  EXPECT_NEAR(high, 1.59f, 0.02f);
  EXPECT_EQ(load("web3d_pythonSAI/KoreanCharacterMotionAnnexD01Jin.x3d").motions.size(), 1u);
}

TEST(Corpus, KickingJoeRestsInTheDefaultPoseAndKicksAsTheFileShows) {
  NEEDS_CORPUS();
  Character joe = load("hanim_utility_kit/JoeHAnimKick1a.x3d");
  Pose pose = make_rest_pose(joe);
  SkinScratch scratch;
  std::vector<vec3> rest, kick, normals;
  skin(joe, pose, mat4(1), scratch, rest, normals);
  for (size_t j = 0; j < joe.joints.size(); j++) pose.rotations[j] = joe.joints[j].rest_rotation;
  skin(joe, pose, mat4(1), scratch, kick, normals);
  auto width = [](const std::vector<vec3>& p) {
    float low = 1e9f, high = -1e9f;
    for (vec3 v : p) low = std::min(low, v.x), high = std::max(high, v.x);
    return high - low;
  };
  EXPECT_LT(width(rest), 0.6f);
  EXPECT_GT(width(kick), 1.0f);
}

TEST(Corpus, TruncatedFiguresAreRefused) {
  NEEDS_CORPUS();
  std::ifstream in(corpus / "web3d_pythonSAI/Humanoid1.x3d", std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  test::TemporaryFile file("");
  for (size_t length = 1; length + 10 < text.size(); length += 97 * 9) {
    std::ofstream(file.path(), std::ios::binary | std::ios::trunc) << text.substr(0, length);
    EXPECT_THROW(load_character(file.path()), LoadError) << length;
  }
}

}  // namespace
}  // namespace wellspring::test
