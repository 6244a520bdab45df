// SPDX-License-Identifier: Apache-2.0
// Tells the pages of a watched exhibit what is wrong with its files, while the old one goes on.
#pragma once
#include <string>

#include "show/state/show.h"

namespace wellspring::show {

// {"type": "problems", "list": [{file, where, what}]}; an empty list: all is mended.
std::string write_problems(const std::vector<Problem>& problems);

// From now on these: to all visitors, and by `hello` to those who come. Nothing is sent where that
// is no news.
void set_problems(Show& show, std::vector<Problem> problems);

}  // namespace wellspring::show
