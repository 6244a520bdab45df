// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/hanim_names.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>

namespace wellspring::avatar {
namespace {

struct Row {
  const char* name;  // a left joint stands for its right twin too
  int level;
  const char* aliases;  // blank-separated, without the l_ of a left joint
};

constexpr Row rows[] = {
    {"humanoid_root", 0, "HumanoidRoot"},
    {"sacroiliac", 1, "SIJ"},
    {"l_hip", 1, ""},
    {"l_knee", 1, ""},
    {"l_talocrural", 1, "ankle"},
    {"l_talocalcaneonavicular", 4, "talocalcaneal"},
    {"l_cuneonavicular_1", 4, ""},
    {"l_tarsometatarsal_1", 4, ""},
    {"l_metatarsophalangeal_1", 4, ""},
    {"l_tarsal_interphalangeal_1", 4, ""},
    {"l_cuneonavicular_2", 4, "cuneonavicular"},
    {"l_tarsometatarsal_2", 2, "subtalar tarsometatarsal"},
    {"l_metatarsophalangeal_2", 1, "midtarsal metatarsophalangeal"},
    {"l_tarsal_proximal_interphalangeal_2", 4, "tarsal_proximal_interphalangeal"},
    {"l_tarsal_distal_interphalangeal_2", 2, "tarsal_distal_interphalangeal metatarsal"},
    {"l_cuneonavicular_3", 4, ""},
    {"l_tarsometatarsal_3", 4, ""},
    {"l_metatarsophalangeal_3", 4, ""},
    {"l_tarsal_proximal_interphalangeal_3", 4, ""},
    {"l_tarsal_distal_interphalangeal_3", 4, ""},
    {"l_calcaneocuboid", 4, "calcaneuscuboid"},
    {"l_transversetarsal", 4, ""},
    {"l_tarsometatarsal_4", 4, ""},
    {"l_metatarsophalangeal_4", 4, ""},
    {"l_tarsal_proximal_interphalangeal_4", 4, ""},
    {"l_tarsal_distal_interphalangeal_4", 4, ""},
    {"l_tarsometatarsal_5", 4, ""},
    {"l_metatarsophalangeal_5", 4, ""},
    {"l_tarsal_proximal_interphalangeal_5", 4, ""},
    {"l_tarsal_distal_interphalangeal_5", 4, ""},
    {"vl5", 1, ""},
    {"vl4", 3, ""},
    {"vl3", 2, ""},
    {"vl2", 3, ""},
    {"vl1", 2, ""},
    {"vt12", 3, ""},
    {"vt11", 3, ""},
    {"vt10", 2, ""},
    {"vt9", 3, ""},
    {"vt8", 3, ""},
    {"vt7", 3, ""},
    {"vt6", 2, ""},
    {"vt5", 3, ""},
    {"vt4", 3, ""},
    {"vt3", 3, ""},
    {"vt2", 3, ""},
    {"vt1", 2, ""},
    {"vc7", 3, ""},
    {"vc6", 3, ""},
    {"vc5", 3, ""},
    {"vc4", 2, ""},
    {"vc3", 3, ""},
    {"vc2", 2, ""},
    {"vc1", 3, ""},
    {"skullbase", 1, ""},
    {"l_eyelid_joint", 3, ""},
    {"l_eyeball_joint", 3, ""},
    {"l_eyebrow_joint", 3, ""},
    {"temporomandibular", 3, ""},
    {"l_sternoclavicular", 2, ""},
    {"l_acromioclavicular", 2, ""},
    {"l_shoulder", 1, ""},
    {"l_elbow", 1, ""},
    {"l_radiocarpal", 1, "wrist"},
    {"l_midcarpal_1", 4, ""},
    {"l_carpometacarpal_1", 2, "thumb1"},
    {"l_metacarpophalangeal_1", 2, "thumb2"},
    {"l_carpal_interphalangeal_1", 2, "thumb3"},
    {"l_midcarpal_2", 4, ""},
    {"l_carpometacarpal_2", 2, "index0 carpometacarpal"},
    {"l_metacarpophalangeal_2", 2, "index1 metacarpophalangeal"},
    {"l_carpal_proximal_interphalangeal_2", 2, "index2 carpal_proximal_interphalangeal"},
    {"l_carpal_distal_interphalangeal_2", 2, "index3 carpal_distal_interphalangeal"},
    {"l_midcarpal_3", 4, ""},
    {"l_carpometacarpal_3", 2, "middle0"},
    {"l_metacarpophalangeal_3", 2, "middle1"},
    {"l_carpal_proximal_interphalangeal_3", 2, "middle2"},
    {"l_carpal_distal_interphalangeal_3", 2, "middle3"},
    {"l_midcarpal_4_5", 4, ""},
    {"l_carpometacarpal_4", 2, "ring0"},
    {"l_metacarpophalangeal_4", 2, "ring1"},
    {"l_carpal_proximal_interphalangeal_4", 2, "ring2"},
    {"l_carpal_distal_interphalangeal_4", 2, "ring3"},
    {"l_carpometacarpal_5", 2, "pinky0"},
    {"l_metacarpophalangeal_5", 2, "pinky1"},
    {"l_carpal_proximal_interphalangeal_5", 2, "pinky2"},
    {"l_carpal_distal_interphalangeal_5", 2, "pinky3"},
};

struct Known {
  std::string name;
  int level;
};

// Maps every name and alias to its joint.
const std::unordered_map<std::string, Known>& known_joints() {
  static const auto table = [] {
    std::unordered_map<std::string, Known> made;
    for (const Row& row : rows) {
      std::string name = row.name;
      bool sided = name.rfind("l_", 0) == 0;
      for (const char* side : {"l_", "r_"}) {
        std::string full = sided ? std::string(side).append(name, 2) : name;
        made.emplace(full, Known{full, row.level});
        std::string aliases = row.aliases;
        for (size_t start = 0; start < aliases.size();) {
          size_t stop = std::min(aliases.find(' ', start), aliases.size());
          std::string alias = aliases.substr(start, stop - start);
          made.emplace(sided ? side + alias : alias, Known{full, row.level});
          start = stop + 1;
        }
        if (!sided) break;
      }
    }
    return made;
  }();
  return table;
}

}  // namespace

std::string hanim_joint_name(std::string_view text) {
  auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  const auto& table = known_joints();
  // The whole name is tried first, then what follows each underscore: the longest known remainder
  // wins.
  for (size_t start = 0; start < text.size();) {
    auto found = table.find(std::string(text.substr(start)));
    if (found != table.end()) return found->second.name;
    size_t underscore = text.find('_', start);
    if (underscore == std::string_view::npos) break;
    start = underscore + 1;
  }
  return "";
}

int hanim_joint_level(std::string_view joint) {
  auto found = known_joints().find(std::string(joint));
  return found == known_joints().end() || found->second.name != joint ? -1 : found->second.level;
}

int level_of_articulation(const std::vector<std::string_view>& joints) {
  int found[5] = {};
  std::vector<std::string_view> unique = joints;
  std::sort(unique.begin(), unique.end());
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  for (std::string_view joint : unique) {
    int level = hanim_joint_level(joint);
    for (int l = std::max(level, 0); level >= 0 && l < 5; l++) found[l]++;
  }
  int level = -1;
  while (level < 4 && found[level + 1] == hanim_joint_count(level + 1)) level++;
  return level;
}

int hanim_joint_count(int level) {
  constexpr int counts[] = {1, 18, 71, 94, 146};
  return level < 0 || level > 4 ? 0 : counts[level];
}

}  // namespace wellspring::avatar
