// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/describe.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "avatar/figure/hanim_names.h"

namespace wellspring::avatar {
namespace {

// Displacers that change materials, each once.
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

// Most joints that move one vertex.
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
