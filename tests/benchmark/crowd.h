// SPDX-License-Identifier: Apache-2.0
// A crowd that strolls through the castle of a server of its own, and what it sees and costs. They
// share the cores with the server, and with whatever else runs on the machine.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "report.h"

namespace wellspring::test {

struct CrowdPlan {
  int visitors = 1, width = 640, height = 360;
  bool local = false;  // pages draw by themselves
  double warm_up = 4, seconds = 8;
  bool one_core = false;  // the server keeps to the last of the cores
};

struct CrowdSeen {
  std::vector<double> latencies;  // milliseconds from an input to its picture, of all
  double keyframes = 0;           // drawn for each visitor, a second
  double pictures = 0;            // came to each visitor, a second
  double bytes = 0;               // one has, in the mean
  std::vector<double> scales;     // keyframes have these: width over what was asked for
  double server_cores = 0, visitors_cores = 0, other_cores = 0;  // were taken meanwhile
  double others = 0;  // other sessions with a thread that wanted a core: each gets as much as ours
  double resident = 0;  // bytes of the server, in the end
  // Figures of /metrics by name without what they begin with, as means over the visitors: their
  // medians over the time, and what they were when it began and ended.
  std::map<std::string, double> metrics, begun, ended;
  // Returns by how much a figure grew in a second.
  double growth(const std::string& name) const;
  double watched = 0;  // seconds from begun to ended
};

// Runs a server, lets all of them in, and lets them stroll. Throws std::runtime_error where a visit
// ends by itself, or the server does not start.
CrowdSeen measure_crowd(const BenchOptions& options, const CrowdPlan& plan);

}  // namespace wellspring::test
