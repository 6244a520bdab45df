// SPDX-License-Identifier: Apache-2.0
// GET /api/v1/status: how the server is, for the page /status. Numbers and words, never pictures.
#pragma once
#include <mutex>
#include <string>

#include "show/http/answer.h"
#include "show/status/judge.h"

namespace wellspring::show {

// How one exhibit is.
struct Standing {
  std::string exhibit;
  ShowReport report;
  std::vector<Finding> findings;
};

// {"fine", "findings": [{exhibit, about, grave, what, seconds (that it has been so), why, remedy}],
//  "house": {open, quiet}, "kiosks": [{name, exhibit, stage, people, storyteller, screens,
//  cameras}], "cameras": [{kiosk, name, state, seconds}], "sums": boolean: there are some}. What is
//  wrong in several exhibits alike is told once; what failed to load is told, too.
std::string write_status(const std::vector<Standing>& exhibits,
                         const std::vector<FailedExhibit>& failed, bool sums);

// One thread sees reports of an exhibit, others ask.
class StatusDesk {
 public:
  explicit StatusDesk(const std::string& exhibit) { standing_.exhibit = exhibit; }
  void see(const ShowReport& report);
  Standing tell() const;

 private:
  JudgeMemory memory_;
  mutable std::mutex mutex_;
  Standing standing_;
};

}  // namespace wellspring::show
