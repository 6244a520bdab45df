// SPDX-License-Identifier: Apache-2.0
// The data in avatar/library/ as compiled into the program, so that no installation lacks it.
#pragma once
#include <string_view>

namespace wellspring::avatar {

std::string_view default_gestures_json();
std::string_view default_expressions_json();

}  // namespace wellspring::avatar
