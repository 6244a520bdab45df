// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/problem.h"

namespace wellspring::show {
namespace {

std::string join(const std::vector<Problem>& problems) {
  std::string all;
  for (const Problem& problem : problems)
    if (problem.fatal) all += (all.empty() ? "" : "\n") + to_string(problem);
  return all;
}

}  // namespace

std::string to_string(const Problem& problem) {
  return problem.file + (problem.where.empty() ? "" : ": " + problem.where) + ": " + problem.what;
}

ExhibitError::ExhibitError(std::vector<Problem> problems_)
    : std::runtime_error(join(problems_)), problems(std::move(problems_)) {}

}  // namespace wellspring::show
