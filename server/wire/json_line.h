// SPDX-License-Identifier: Apache-2.0
// Where in a text of JSON a value stands, for messages to who wrote it.
#pragma once
#include <string>
#include <string_view>

namespace wellspring::wire {

// The line, from 1, of the value at `place` ("/cameras/0/name", names as they are written), where
// its name stands; of the last of equal names. 0: there is none.
int find_json_line(std::string_view text, const std::string& place);

}  // namespace wellspring::wire
