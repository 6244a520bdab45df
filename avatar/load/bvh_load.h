// SPDX-License-Identifier: Apache-2.0
// Reads Biovision hierarchies (.bvh): a skeleton and one recorded motion of it. Order of channels,
// letter case, line ends and blanks are as lax as files of many programs need; text without a
// meaning is refused with its line.
#pragma once
#include <string>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

bool is_bvh(const std::string& text);

// Makes a figure without surface whose motions[0] is the recording (none if the file has no frame).
// Sizes in other units than metres become metres by the skeleton's height. Throws LoadError.
Character character_from_bvh(const std::string& path, const std::string& text);

}  // namespace wellspring::avatar
