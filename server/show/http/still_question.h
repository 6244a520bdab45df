// SPDX-License-Identifier: Apache-2.0
// The query of still.jpg: which finished picture is asked for, within which bounds.
#pragma once
#include <map>
#include <string>

#include "show/http/still.h"
#include "show/exhibit/exhibit.h"

namespace wellspring::show {

struct StillQuestion {
  StillJob job;
  int status = 200;           // of HTTP; 200: `job` may be done
  std::string code, problem;  // what is wrong with it otherwise, and with which field
};

StillQuestion read_still_question(const Exhibit& exhibit,
                                  const std::map<std::string, std::string>& query);

}  // namespace wellspring::show
