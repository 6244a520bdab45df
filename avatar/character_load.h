// SPDX-License-Identifier: Apache-2.0
// H-Anim files to a Character. Throws LoadError naming file and line (or node). Cost linear in the
// file.
#pragma once
#include <string>

#include "avatar/character.h"

namespace wellspring {

Character load_character(const std::string& path);

}  // namespace wellspring
