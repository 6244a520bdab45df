// SPDX-License-Identifier: Apache-2.0
// Tells programs apart that may find other bits, though their version is the same.
#pragma once
#include <string>

namespace wellspring::workers {

// Returns "VERSION+NUMBER"; the number is of all sources below server/, and of the compiler
// (cmake/program_number.cmake).
std::string program_number(const std::string& version);

}  // namespace wellspring::workers
