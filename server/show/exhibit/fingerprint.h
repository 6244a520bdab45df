// SPDX-License-Identifier: Apache-2.0
// A number that changes with the files of an exhibit and with this program: what is kept on disk
// from one start to the next is found again by it.
#pragma once
#include <cstdint>
#include <string>

namespace wellspring {

// Names, sizes and times of all files in the folder, and of the program. Never throws.
uint64_t exhibit_fingerprint(const std::string& folder);

}  // namespace wellspring
