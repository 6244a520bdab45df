// SPDX-License-Identifier: Apache-2.0
// What a character consists of, for people (text) and for programs (JSON).
#pragma once
#include <string>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

std::string describe_text(const Character& character);
std::string describe_json(const Character& character);

}  // namespace wellspring::avatar
