// SPDX-License-Identifier: Apache-2.0
// What is wrong with an exhibit package: every fault is noted with file and place, not only the
// first.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace wellspring::show {

struct Problem {
  std::string file, where, what;
  bool fatal = true;  // false: the exhibit runs, but a curator should know
};
std::string to_string(const Problem& problem);  // "file: where: what"

struct ExhibitError : std::runtime_error {
  std::vector<Problem> problems;
  explicit ExhibitError(std::vector<Problem> problems);
};

}  // namespace wellspring::show
