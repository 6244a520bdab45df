// SPDX-License-Identifier: Apache-2.0
#include "show/watch/problems.h"

#include <nlohmann/json.hpp>

namespace wellspring::show {

using nlohmann::json;

std::string write_problems(const std::vector<Problem>& problems) {
  json message = {{"type", "problems"}, {"list", json::array()}};
  for (const Problem& problem : problems)
    message["list"].push_back(
        {{"file", problem.file}, {"where", problem.where}, {"what", problem.what}});
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

void set_problems(Show& show, std::vector<Problem> problems) {
  const std::string message = problems.empty() && show.problems_message.empty()
                                  ? std::string()  // nothing was ever wrong
                                  : write_problems(problems);
  show.problems = std::move(problems);
  if (message == show.problems_message) return;
  show.problems_message = message;
  for (Visitor& visitor : show.visitors)
    if (visitor.welcomed) visitor.link->send_text(message);
}

}  // namespace wellspring::show
