// SPDX-License-Identifier: Apache-2.0
// Checks every figure, whatever file it comes from.
#pragma once
#include <string>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

// Puts the figure on y = 0 (motions along with it) and adds warnings: joints of the face that lie
// where no face is, a size no person has. Called once, at the end of loading.
void check_figure(Character& character);

// Describes a character's contents, for people (text) and for programs (JSON).

std::string describe_text(const Character& character);
std::string describe_json(const Character& character);

}  // namespace wellspring::avatar
