// SPDX-License-Identifier: Apache-2.0
// What is wrong, since when, and what to do: a function of the reports so far and of nothing else.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "show/http/report.h"

namespace wellspring::show {

// Its words make one line: "WHAT since 14:03: WHY. REMEDY"
struct Finding {
  std::string about;   // the same for the same problem: "camera hall/left"
  bool grave = false;  // guests notice
  std::string what;    // "No camera at kiosk 'hall'"
  double since = 0;    // report time
  std::string why;     // "2 cores are not enough for 5 visitors"; may be empty
  std::string remedy;  // "Check its cable and the program 'wellspring kiosk'."
};

// Holds what is remembered from one report to the next; begins empty.
struct JudgeMemory {
  struct Mark {
    double since = 0, last = 0;  // report times at which it was first and last so
    uint64_t before = 0;         // last value of a counter that only grows
  };
  std::map<std::string, Mark> marks;                     // by Finding::about
  std::map<std::string, uint64_t> counted;               // likewise, as of the last report
  std::map<std::string, double> had_camera, had_screen;  // kiosks, and when last
  double began = -1;                                     // time of the first report
};

// Returns grave findings first, then in the order of their beginning. A problem that comes and goes
// is reported when it has lasted a moment, and a moment longer than it lasts; one that is counted,
// for ten minutes after.
std::vector<Finding> judge(const ShowReport& report, JudgeMemory& memory);

}  // namespace wellspring::show
