// SPDX-License-Identifier: Apache-2.0
// The castle's own figures: whole, even, and with faces that do what their displacers say.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "avatar/load/character_load.h"
#include "avatar/figure/rig.h"
#include "avatar/figure/skin.h"

namespace wellspring::test {
namespace {

const char* const displacer_names[] = {
    "breathe",        "blink_l",       "blink_r",      "lid_wide",  "squint",     "brow_up_l",
    "brow_up_r",      "brow_inner_up", "brow_down",    "cheek_up",  "smile_l",    "smile_r",
    "frown",          "mouth_open",    "lips_pucker",  "lips_wide", "lips_press", "upper_lip_up",
    "lower_lip_down", "cheek_puff",    "nose_wrinkle", "viseme_pp", "viseme_ff",  "viseme_th",
    "viseme_dd",      "viseme_kk",     "viseme_ch",    "viseme_ss", "viseme_nn",  "viseme_rr",
    "viseme_aa",      "viseme_e",      "viseme_ih",    "viseme_oh", "viseme_ou"};

class CastleFigure : public testing::TestWithParam<const char*> {
 protected:
  static const Character& character() {  // loaded once for all tests of a figure
    static std::map<std::string, Character> loaded;
    auto [place, added] = loaded.try_emplace(GetParam());
    if (added)
      place->second =
          load_character(std::string(WELLSPRING_SOURCE) + "/content/castle/figures/" + GetParam());
    return place->second;
  }

  std::vector<vec3> posed(std::initializer_list<std::pair<const char*, float>> face) const {
    const Character& c = character();
    Pose pose = make_rest_pose(c);
    for (auto [name, weight] : face) pose.displacers[size_t(find_displacer(c, name))] = weight;
    SkinScratch scratch;
    std::vector<vec3> positions, normals;
    skin(c, pose, mat4(1), scratch, positions, normals);
    for (vec3 n : normals) EXPECT_NEAR(glm::length(n), 1, 1e-3f);
    return positions;
  }

  vec3 site(const char* name) const {
    for (const Site& site : character().sites)
      if (site.name == name) return site.position;
    ADD_FAILURE() << "no site " << name;
    return vec3(0);
  }

  // The part somebody in front sees at (x, y).
  std::string seen_at(const std::vector<vec3>& p, float x, float y) const {
    std::string part;
    float nearest = -INFINITY;
    for (const Part& candidate : character().parts)
      for (uvec3 t : candidate.triangles) {
        vec3 a = p[t.x], b = p[t.y], c = p[t.z];
        float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if (area == 0) continue;
        float v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
        float w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
        if (v < 0 || w < 0 || v + w > 1) continue;
        float z = a.z + v * (b.z - a.z) + w * (c.z - a.z);
        if (z > nearest) nearest = z, part = candidate.name;
      }
    return part;
  }
};

bool is_inside_of_mouth(const std::string& part) {
  return part.find("mouth") != std::string::npos || part.find("teeth") != std::string::npos ||
         part.find("gums") != std::string::npos || part.find("tongue") != std::string::npos;
}

TEST_P(CastleFigure, IsWholeAndKnownToTheRig) {
  const Character& c = character();
  EXPECT_TRUE(c.warnings.empty()) << c.warnings[0];
  EXPECT_EQ(c.loa, 3);
  EXPECT_EQ(c.joints.size(), 94u);
  EXPECT_EQ(c.displacers.size(), std::size(displacer_names));
  for (const char* name : displacer_names) EXPECT_GE(find_displacer(c, name), 0) << name;
  for (const Appearance& appearance : c.appearances)
    if (!appearance.texture.empty())
      EXPECT_TRUE(std::filesystem::exists(appearance.texture)) << appearance.texture;
  for (const Appearance& appearance :
       c.appearances)  // near the eye, relief is too fine for triangles
    if (appearance.texture.find("_skin.") != std::string::npos ||
        appearance.texture.find("_hair.") != std::string::npos)
      EXPECT_TRUE(std::filesystem::exists(appearance.normal_texture)) << appearance.texture;
  Rig rig = make_rig(c);
  EXPECT_TRUE(rig.eyes_move);
  EXPECT_TRUE(rig.leg[0].complete() && rig.leg[1].complete());
  EXPECT_GE(rig.arm[0].fingers.size(), 12u);
  for (size_t i = 1; i < rig.viseme.size(); i++) EXPECT_GE(rig.viseme[i], 0) << i;
}

TEST_P(CastleFigure, WeightsAndTrianglesAreSound) {
  const Character& c = character();
  for (size_t v = 0; v < c.positions.size(); v++) {
    float sum = 0;
    uint32_t first = c.first_weight[v], last = c.first_weight[v + 1];
    EXPECT_LE(last - first, 6u) << v;
    for (uint32_t i = first; i < last; i++) sum += c.weights[i].weight;
    EXPECT_NEAR(sum, 1, 1e-4f) << v;
  }
  size_t flat = 0, all = 0;
  for (const Part& part : c.parts)
    for (uvec3 t : part.triangles) {
      vec3 n = cross(c.positions[t.y] - c.positions[t.x], c.positions[t.z] - c.positions[t.x]);
      flat += glm::length(n) < 1e-9f;
      all++;
    }
  EXPECT_LT(flat, all / 500);
  EXPECT_LT(all, 65000u);  // a tick can afford so many
}

TEST_P(CastleFigure, FacesMoveAlikeOnBothSides) {
  const Character& c = character();
  struct Sum {
    double left = 0, right = 0;
  };
  auto sum_of = [&](const std::string& name) {
    Sum sum;
    const Displacer& d = c.displacers[size_t(find_displacer(c, name))];
    for (size_t i = 0; i < d.vertices.size(); i++) {
      float x = c.positions[d.vertices[i]].x;
      if (std::abs(x) < 0.002f) continue;  // the middle line belongs to both
      (x > 0 ? sum.left : sum.right) += double(glm::length(d.displacements[i]));
    }
    return sum;
  };
  for (const char* name : displacer_names) {
    std::string text = name;
    bool sided = text.size() > 2 && (text.ends_with("_l") || text.ends_with("_r"));
    Sum sum = sum_of(text);
    EXPECT_GT(sum.left + sum.right, 0) << name;
    if (!sided) {
      EXPECT_NEAR(sum.left, sum.right, 0.05 * (sum.left + sum.right)) << name;
    } else if (text.ends_with("_l")) {
      Sum other = sum_of(text.substr(0, text.size() - 1) + "r");
      EXPECT_NEAR(sum.left, other.right, 0.05 * sum.left) << name;
      EXPECT_LT(sum.right, 0.1 * sum.left) << name;
    }
  }
}

TEST_P(CastleFigure, ClosedLidsCoverTheEyes) {
  vec3 between = site("skull_view");
  std::vector<vec3> open = posed({}), closed = posed({{"blink_l", 1.0f}, {"blink_r", 1.0f}});
  float pupil = 0;
  for (const Joint& joint : character().joints)
    if (joint.name == "l_eyeball_joint") pupil = joint.center.x;
  for (float side : {-1.0f, 1.0f}) {
    EXPECT_EQ(seen_at(open, side * pupil, between.y).find("shape_eyeball"), 0u);
    for (float dx : {-0.008f, -0.004f, 0.0f, 0.004f, 0.008f})
      for (float dy : {-0.007f, -0.0035f, 0.0f, 0.003f}) {
        std::string part = seen_at(closed, side * pupil + dx, between.y + dy);
        EXPECT_EQ(part.find("eyeball"), std::string::npos) << side << " " << dx << " " << dy;
      }
  }
}

TEST_P(CastleFigure, LipsMeetAndOpen) {
  vec3 mouth = site("mouth_pt");
  std::vector<vec3> shut = posed({{"viseme_pp", 1.0f}}), open = posed({{"viseme_aa", 1.0f}});
  for (float x : {-0.012f, -0.006f, 0.0f, 0.006f, 0.012f}) {
    for (float dy = -0.004f; dy <= 0.004f; dy += 0.00025f)
      EXPECT_FALSE(is_inside_of_mouth(seen_at(shut, x, mouth.y + dy))) << x << " " << dy;
    // The middle of the opening shows what lies behind the lips: no beard hangs into it.
    EXPECT_TRUE(is_inside_of_mouth(seen_at(open, x, mouth.y - 0.008f)))
        << x << ": " << seen_at(open, x, mouth.y - 0.008f);
  }
}

// Lids at rest touch the iris, whose rim is 6.2 mm from the pupil's middle: a white rim above it
// stares. Wide open they leave it.
TEST_P(CastleFigure, UpperLidsLieOnTheIris) {
  vec3 between = site("skull_view");
  float pupil = 0;
  for (const Joint& joint : character().joints)
    if (joint.name == "l_eyeball_joint") pupil = joint.center.x;
  std::vector<vec3> rest = posed({}), wide = posed({{"lid_wide", 1.0f}});
  for (float side : {-1.0f, 1.0f}) {
    float x = side * pupil, rim = between.y + 0.0062f;
    EXPECT_EQ(seen_at(rest, x, rim).find("eyeball"), std::string::npos) << side;
    EXPECT_NE(seen_at(rest, x, rim - 0.0025f).find("eyeball"), std::string::npos) << side;
    EXPECT_NE(seen_at(wide, x, rim).find("eyeball"), std::string::npos) << side;
  }
}

// A glad smile bares the upper teeth, draws both corners of the mouth up in an arc and lifts the
// cheeks against the lids.
TEST_P(CastleFigure, GladnessShowsTeethAndReachesTheEyes) {
  const Character& c = character();
  vec3 mouth = site("mouth_pt");
  std::vector<vec3> rest = posed({});
  std::vector<vec3> glad = posed({{"smile_l", 1.0f},
                                  {"smile_r", 1.0f},
                                  {"cheek_up", 0.75f},
                                  {"upper_lip_up", 0.5f},
                                  {"mouth_open", 0.1f}});
  for (float x : {-0.008f, -0.004f, 0.004f, 0.008f}) {
    bool teeth = false;
    for (float dy = -0.008f; dy <= 0.008f; dy += 0.0005f)
      teeth |= seen_at(glad, x, mouth.y + dy).find("upper_teeth") != std::string::npos;
    EXPECT_TRUE(teeth) << x;
  }
  auto rise = [&](float x, float y, float within) {  // mean of the skin near a place, both sides
    double sum = 0;
    int count = 0;
    for (const Part& part : c.parts)
      if (part.name == "shape_face")
        for (uvec3 t : part.triangles)
          for (int k = 0; k < 3; k++) {
            vec3 p = rest[t[k]];
            if (p.z < mouth.z - 0.04f) continue;
            if (std::hypot(std::abs(p.x) - x, p.y - y) > within) continue;
            sum += double(glad[t[k]].y - p.y);
            count++;
          }
    EXPECT_GT(count, 0);
    return sum / std::max(count, 1);
  };
  double middle = rise(0, mouth.y - 0.008f, 0.004f), half = rise(0.013f, mouth.y - 0.005f, 0.004f),
         corner = rise(0.0255f, mouth.y + 0.001f, 0.003f);
  EXPECT_GT(corner, half);
  EXPECT_GT(half, middle);
  EXPECT_GT(rise(0.037f, mouth.y + 0.036f, 0.006f), 0.002);
}

// Hair of the beard stays where it grows when the face beneath it moves.
TEST_P(CastleFigure, BeardFollowsTheSkin) {
  const Character& c = character();
  std::vector<uint32_t> beard, face;
  for (const Part& part : c.parts) {
    std::vector<uint32_t>* into = part.name.find("beard") != std::string::npos ? &beard
                                  : part.name == "shape_face"                  ? &face
                                                                               : nullptr;
    if (!into) continue;
    for (uvec3 t : part.triangles)
      for (int k = 0; k < 3; k++) into->push_back(t[k]);
    std::sort(into->begin(), into->end());
    into->erase(std::unique(into->begin(), into->end()), into->end());
  }
  if (beard.empty()) GTEST_SKIP() << "no beard";
  struct Root {
    uint32_t hair, skin;
  };
  std::vector<Root> roots;
  for (size_t i = 0; i < beard.size(); i += 3)
    for (uint32_t v : face)
      if (glm::length(c.positions[beard[i]] - c.positions[v]) < 0.0015f) {
        roots.push_back({beard[i], v});
        break;
      }
  ASSERT_GT(roots.size(), 100u);
  for (const char* name : {"viseme_aa", "smile_l", "lips_pucker", "upper_lip_up", "frown"}) {
    std::vector<vec3> now = posed({{name, 1.0f}});
    std::vector<float> slips;
    for (Root root : roots) {
      vec3 before = c.positions[root.hair] - c.positions[root.skin];
      slips.push_back(glm::length(now[root.hair] - now[root.skin] - before));
    }
    std::sort(slips.begin(), slips.end());
    EXPECT_LT(slips[slips.size() * 9 / 10], 0.003f) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Castle, CastleFigure, testing::Values("storyteller.x3d", "chronicler.x3d"),
                         [](const auto& info) {
                           std::string name = info.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace wellspring::test
