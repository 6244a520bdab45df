// SPDX-License-Identifier: Apache-2.0
// Finds where in a text of JSON a value stands, for messages to its author.
#pragma once
#include <string>
#include <string_view>

namespace wellspring::wire {

// Returns the line, from 1, at which the name of the value at `place` stands ("/cameras/0/name",
// names as they are written), or the value itself in a list; of equal names the last. 0: there is
// none.
int find_json_line(std::string_view text, const std::string& place);

}  // namespace wellspring::wire
