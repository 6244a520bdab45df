// SPDX-License-Identifier: Apache-2.0
#include "figures.h"

#include <functional>
#include <map>
#include <sstream>
#include <vector>

namespace wellspring::test {

std::string whole_figure() {
  struct Bone {
    std::string name, parent;
    vec3 center;
  };
  std::vector<Bone> bones = {{"humanoid_root", "", {0, 0.9f, 0}},
                             {"sacroiliac", "humanoid_root", {0, 0.93f, 0}},
                             {"vl5", "humanoid_root", {0, 1.0f, -0.03f}},
                             {"vt6", "vl5", {0, 1.25f, -0.05f}},
                             {"vc4", "vt6", {0, 1.45f, -0.03f}},
                             {"skullbase", "vc4", {0, 1.52f, 0}},
                             {"temporomandibular", "skullbase", {0, 1.51f, 0.01f}}};
  for (std::string s : {"l_", "r_"}) {
    float x = s == "l_" ? 1.0f : -1.0f;
    bones.push_back({s + "hip", "sacroiliac", {0.09f * x, 0.88f, 0}});
    bones.push_back({s + "knee", s + "hip", {0.09f * x, 0.48f, 0.01f}});
    bones.push_back({s + "talocrural", s + "knee", {0.09f * x, 0.08f, -0.02f}});
    bones.push_back({s + "shoulder", "vt6", {0.17f * x, 1.38f, -0.02f}});
    bones.push_back({s + "elbow", s + "shoulder", {0.20f * x, 1.10f, -0.03f}});
    bones.push_back({s + "radiocarpal", s + "elbow", {0.22f * x, 0.86f, 0}});
    bones.push_back({s + "eyeball_joint", "skullbase", {0.032f * x, 1.59f, 0.07f}});
    for (int f = 2; f <= 5; f++) {
      std::string n = std::to_string(f);
      float z = 0.03f - 0.02f * float(f - 2);
      bones.push_back({s + "metacarpophalangeal_" + n, s + "radiocarpal", {0.225f * x, 0.77f, z}});
      bones.push_back({s + "carpal_proximal_interphalangeal_" + n,
                       s + "metacarpophalangeal_" + n,
                       {0.225f * x, 0.73f, z}});
    }
  }
  std::map<std::string, std::vector<const Bone*>> children;
  for (const Bone& bone : bones) children[bone.parent].push_back(&bone);
  std::ostringstream out;
  std::function<void(const Bone&, bool)> write = [&](const Bone& bone, bool first) {
    out << "<HAnimJoint name='" << bone.name << "' center='" << bone.center.x << ' '
        << bone.center.y << ' ' << bone.center.z << "'"
        << (first ? " containerField='skeleton'" : "") << ">\n";
    out << "<HAnimSegment name='s_" << bone.name << "'><Transform translation='" << bone.center.x
        << ' ' << bone.center.y << ' ' << bone.center.z
        << "'><Shape><Box size='0.03 0.03 0.03'/></Shape></Transform>";
    if (bone.name == "skullbase") {
      out << "<Shape><IndexedFaceSet coordIndex='0 1 2 -1'><Coordinate DEF='lids' point='0 1.6 0.1 "
             "0.01 1.6 0.1 0 1.61 "
             "0.1'/></IndexedFaceSet></Shape><Coordinate USE='lids' containerField='coord'/>";
      for (const char* name : {"blink_l", "blink_r", "smile_l", "smile_r", "mouth_open", "breathe",
                               "viseme_aa", "viseme_PP", "lid_wide"})
        out << "<HAnimDisplacer name='" << name << "' coordIndex='2' displacements='0 -0.01 0'/>";
    }
    out << "</HAnimSegment>\n";
    for (const Bone* child : children[bone.name]) write(*child, false);
    out << "</HAnimJoint>\n";
  };
  out << "<HAnimHumanoid name='Whole' loa='1'>\n";
  write(bones[0], true);
  out << "</HAnimHumanoid>";
  return x3d(out.str());
}

}  // namespace wellspring::test
