// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/figure_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "avatar/figure/hanim_names.h"

namespace wellspring::avatar {
namespace {

struct Box {
  vec3 low{INFINITY}, high{-INFINITY};
  bool empty() const { return !(low.x <= high.x); }
  bool holds(vec3 p, float margin) const {
    for (int i = 0; i < 3; i++)
      if (p[i] < low[i] - margin || p[i] > high[i] + margin) return false;
    return true;
  }
};

std::string centimetres(float metres) {
  return std::to_string(int(std::lround(metres * 100))) + " cm";
}

// Finds the head: around the vertices that follow the skull; for a skull without surface, around
// its joint by the figure's size.
Box head_box(const Character& character, int skull, float height) {
  Box box;
  for (size_t v = 0; v < character.positions.size(); v++)
    for (uint32_t k = character.first_weight[v]; k < character.first_weight[v + 1]; k++) {
      if (character.weights[k].joint != skull || character.weights[k].weight < 0.5f) continue;
      box.low = glm::min(box.low, character.positions[v]);
      box.high = glm::max(box.high, character.positions[v]);
    }
  vec3 centre = character.joints[size_t(skull)].center;
  Box usual{centre - height * vec3(0.08f, 0.06f, 0.1f),
            centre + height * vec3(0.08f, 0.16f, 0.14f)};
  return box.empty() || box.high.y - box.low.y < 0.05f * height ? usual : box;
}

// Joints of some published skeletons lie far from the face they should move.
void check_face_joints(Character& character, float height) {
  int skull = find_joint(character, "skullbase");
  if (skull < 0) return;
  Box head = head_box(character, skull, height);
  auto say = [&](const Joint& joint, const std::string& what) {
    character.warnings.push_back("joint " + joint.name + " " + what + ": misplaced");
  };
  auto place = [&](const char* name) {
    int joint = find_joint(character, name);
    return joint < 0 ? nullptr : &character.joints[size_t(joint)];
  };
  for (const Joint& joint : character.joints) {
    bool face = joint.name.find("_eye") != std::string::npos || joint.name == "temporomandibular";
    vec3 from_skull = joint.center - character.joints[size_t(skull)].center;
    bool below = from_skull.y < -0.05f * height;  // the skull's joint is at its base
    if (face && (below || !head.holds(joint.center, 0.012f * height))) {
      say(joint,
          "lies " + centimetres(glm::length(from_skull)) + " from skullbase, outside the head");
    }
  }
  const Joint* jaw = place("temporomandibular");
  for (const char* side : {"l_", "r_"}) {
    const Joint* eye = place((side + std::string("eyeball_joint")).c_str());
    const Joint* lid = place((side + std::string("eyelid_joint")).c_str());
    const Joint* brow = place((side + std::string("eyebrow_joint")).c_str());
    if (eye && jaw && jaw->center.y > eye->center.y + 0.01f * height)
      say(*jaw, "lies above the eyes");
    if (eye && (eye->center.x < 0) == (side[0] == 'l') && std::abs(eye->center.x) > 0.003f * height)
      say(*eye, "lies on the other side of the head");
    if (eye && lid && glm::length(eye->center - lid->center) > 0.03f * height)
      say(*lid, "lies " + centimetres(glm::length(eye->center - lid->center)) + " from its eye");
    if (eye && brow && brow->center.y < eye->center.y - 0.006f * height)
      say(*brow, "lies below its eye");
  }
}

// Puts the figure on y = 0, as H-Anim figures stand; some files put their origin elsewhere.
void stand_on_floor(Character& character) {
  if (find_joint(character, "l_talocrural") < 0 && find_joint(character, "l_knee") < 0) return;
  if (character.parts.empty() && !character.motions.empty()) return;  // a recording keeps its place
  float low = INFINITY;
  for (vec3 p : character.positions) low = std::min(low, p.y);
  // Surfaces may be missing, or stand on legs that have none.
  for (const Joint& joint : character.joints) {
    bool foot = joint.name.find("talocrural") != std::string::npos ||
                joint.name.find("metatarsophalangeal_2") != std::string::npos;
    if (character.positions.empty()) low = std::min(low, joint.center.y - 0.02f);
    else if (foot) low = std::min(low, joint.center.y);
  }
  if (!std::isfinite(low) || std::abs(low) < 0.03f) return;
  char text[100];
  std::snprintf(text, sizeof text, "feet are at y = %.3f m: the figure is moved to stand on 0",
                double(low));
  character.warnings.push_back(text);
  for (vec3& p : character.positions) p.y -= low;
  for (Joint& joint : character.joints) joint.center.y -= low;
  for (Site& site : character.sites) site.position.y -= low;
  for (SpringCollider& collider : character.spring_colliders)
    collider.place.y -= low, collider.tail.y -= low;
  for (Motion& motion : character.motions)
    for (MotionJoint& joint : motion.joints) joint.center.y -= low;
}

}  // namespace

void check_figure(Character& character) {
  stand_on_floor(character);
  float height = 0, size = 0;
  for (const Joint& joint : character.joints) {
    height = std::max(height, joint.center.y);
    size = std::max(size, glm::length(joint.center));
  }
  check_face_joints(character, std::clamp(height * 1.08f, 0.1f, 100.0f));
  if (size > 20)
    character.warnings.push_back(
        "the figure is more than 20 m large: perhaps its unit is not the metre");
}

namespace {

// Lists displacers that change materials, each once.
std::vector<std::string> painting(const Character& character) {
  std::vector<std::string> names;
  for (const AppearanceChange& change : character.appearance_changes) {
    const std::string& name = character.displacers[size_t(change.displacer)].name;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::string parent_name(const Character& character, int joint) {
  int parent = character.joints[size_t(joint)].parent;
  return parent < 0 ? "" : character.joints[size_t(parent)].name;
}

size_t triangle_count(const Character& character) {
  size_t count = 0;
  for (const Part& part : character.parts) count += part.triangles.size();
  return count;
}

// Returns the greatest number of joints that move one vertex.
size_t most_weights(const Character& character) {
  size_t most = 0;
  for (size_t v = 0; v + 1 < character.first_weight.size(); v++)
    most = std::max<size_t>(most, character.first_weight[v + 1] - character.first_weight[v]);
  return most;
}

std::vector<std::string> unknown_joints(const Character& character) {
  std::vector<std::string> names;
  for (const Joint& joint : character.joints)
    if (hanim_joint_level(joint.name) < 0) names.push_back(joint.name);
  return names;
}

int joints_of_level(const Character& character, int level) {
  int count = 0;
  for (const Joint& joint : character.joints) {
    int l = hanim_joint_level(joint.name);
    count += l >= 0 && l <= level;
  }
  return count;
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char line[400];
  std::snprintf(line, sizeof line, pattern, values...);
  return line;
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "none" : text;
}

}  // namespace

std::string describe_text(const Character& character) {
  std::string text = "name         " + (character.name.empty() ? "(none)" : character.name) + "\n";
  text += format("articulation LOA %d;", character.loa);
  for (int level = 1; level <= 4; level++)
    text += format(" %d of %d joints of LOA %d%s", joints_of_level(character, level),
                   hanim_joint_count(level), level, level < 4 ? "," : "\n");
  text += format(
      "surface      %zu vertices, %zu triangles, %zu parts, %zu looks, up to %zu joints a vertex\n",
      character.positions.size(), triangle_count(character), character.parts.size(),
      character.appearances.size(), most_weights(character));
  text += format("joints       %zu (name, parent, centre in metres)\n", character.joints.size());
  for (size_t j = 0; j < character.joints.size(); j++) {
    const Joint& joint = character.joints[j];
    text += format("  %-38s %-38s %8.4f %8.4f %8.4f%s\n", joint.name.c_str(),
                   parent_name(character, int(j)).c_str(), double(joint.center.x),
                   double(joint.center.y), double(joint.center.z),
                   hanim_joint_level(joint.name) < 0 ? "  (not H-Anim)" : "");
  }
  std::vector<std::string> segments, sites, displacers, motions;
  for (const Segment& segment : character.segments) segments.push_back(segment.name);
  for (const Site& site : character.sites) sites.push_back(site.name);
  for (const Displacer& displacer : character.displacers)
    displacers.push_back(displacer.name + " (" + std::to_string(displacer.vertices.size()) + ")");
  text += format("segments     %zu: ", segments.size()) + join(segments) + "\n";
  text += format("sites        %zu: ", sites.size()) + join(sites) + "\n";
  text += format("displacers   %zu (vertices): ", displacers.size()) + join(displacers) + "\n";
  for (const Motion& motion : character.motions)
    motions.push_back(motion.name + format(" (%.2f s)", double(motion.duration)));
  if (!character.springs.empty())
    text += format("springs      %zu joints swing, %zu colliders\n", character.springs.size(),
                   character.spring_colliders.size());
  if (!character.constraints.empty())
    text += format("constraints  %zu joints follow others\n", character.constraints.size());
  if (std::vector<std::string> names = painting(character); !names.empty())
    text +=
        format("paint        %zu displacers change materials: ", names.size()) + join(names) + "\n";
  text += format("motions      %zu: ", motions.size()) + join(motions) + "\n";
  for (const auto& [key, value] : character.metadata)
    text += "about        " + key + ": " + value + "\n";
  for (const std::string& warning : character.warnings) text += "note         " + warning + "\n";
  return text;
}

std::string describe_json(const Character& character) {
  using json = nlohmann::ordered_json;
  auto micro = [](float v) { return std::round(double(v) * 1e6) / 1e6; };
  auto triple = [&](vec3 v) { return json::array({micro(v.x), micro(v.y), micro(v.z)}); };
  json all;
  all["name"] = character.name;
  all["loa"] = character.loa;
  all["joints"] = json::array();
  for (size_t j = 0; j < character.joints.size(); j++) {
    const Joint& joint = character.joints[j];
    json entry = {{"name", joint.name},
                  {"parent", nullptr},
                  {"center", triple(joint.center)},
                  {"level", hanim_joint_level(joint.name)}};
    if (joint.parent >= 0) entry["parent"] = parent_name(character, int(j));
    all["joints"].push_back(entry);
  }
  auto joint_name = [&](int joint) { return character.joints[size_t(joint)].name; };
  all["segments"] = json::array();
  for (const Segment& segment : character.segments)
    all["segments"].push_back({{"name", segment.name}, {"joint", joint_name(segment.joint)}});
  all["sites"] = json::array();
  for (const Site& site : character.sites)
    all["sites"].push_back({{"name", site.name},
                            {"joint", joint_name(site.joint)},
                            {"position", triple(site.position)}});
  all["displacers"] = json::array();
  for (const Displacer& displacer : character.displacers)
    all["displacers"].push_back(
        {{"name", displacer.name}, {"vertices", displacer.vertices.size()}});
  all["skin"] = {
      {"vertices", character.positions.size()},
      {"triangles", triangle_count(character)},
      {"parts", character.parts.size()},
      {"most_joints_a_vertex", most_weights(character)},
      {"skinning", character.skinning == Skinning::linear ? "linear" : "dual_quaternion"}};
  all["looks"] = json::array();
  for (const Appearance& appearance : character.appearances)
    all["looks"].push_back({{"name", appearance.name}, {"texture", appearance.texture}});
  all["motions"] = json::array();
  for (const Motion& motion : character.motions)
    all["motions"].push_back({{"name", motion.name},
                              {"seconds", micro(motion.duration)},
                              {"loop", motion.loop},
                              {"tracks", motion.tracks.size()}});
  all["springs"] = {{"joints", json::array()}, {"colliders", character.spring_colliders.size()}};
  for (const SpringBone& bone : character.springs)
    all["springs"]["joints"].push_back(joint_name(bone.joint));
  all["constraints"] = json::array();
  for (const JointConstraint& constraint : character.constraints) {
    constexpr const char* kinds[] = {"roll", "aim", "rotation"};
    all["constraints"].push_back({{"joint", joint_name(constraint.joint)},
                                  {"source", joint_name(constraint.source)},
                                  {"kind", kinds[size_t(constraint.kind)]},
                                  {"weight", constraint.weight}});
  }
  all["paint"] = painting(character);
  all["metadata"] = json::object();
  for (const auto& [key, value] : character.metadata) all["metadata"][key] = value;
  all["unknown_joints"] = unknown_joints(character);
  all["warnings"] = character.warnings;
  // Names come from foreign files and need not be UTF-8.
  return all.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace wellspring::avatar
