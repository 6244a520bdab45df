// SPDX-License-Identifier: Apache-2.0
// Lists the 146 joints of ISO/IEC 19774-1:2019, table A, with the names older files use for them.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace wellspring::avatar {

// Returns a joint's name: "Joe_HumanoidRoot " -> "humanoid_root", "r_thumb2" ->
// "r_metacarpophalangeal_1". Blanks are trimmed, H-Anim 1 names translated and a prefix dropped if
// what follows it is known. Returns an empty string for an unknown name.
std::string hanim_joint_name(std::string_view name);

// Returns the level of articulation (0 to 4) that introduces a joint; -1 for a name that is none.
int hanim_joint_level(std::string_view joint);

// Returns the highest level whose joints (and those of all lower levels) are all among `joints`;
// -1: not even 0.
int level_of_articulation(const std::vector<std::string_view>& joints);
int hanim_joint_count(int level);  // 1, 18, 71, 94, 146

}  // namespace wellspring::avatar
