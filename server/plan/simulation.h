// SPDX-License-Identifier: Apache-2.0
// Simulates a museum's servers with their visitors (plan/server_model.h), behind a proxy that sends
// whoever comes to the server with the fewest connections (docs/nodes.md). Time is a number: hours
// pass in moments, and the same seed gives the same numbers.
#pragma once
#include <string>

#include "plan/costs.h"
#include "plan/demand.h"
#include "plan/tally.h"

namespace wellspring::plan {

// Rates are those of a visitor while it walks, a second; shares are of the busiest server.
struct Outcome {
  Tally latency;               // seconds from an input to the first picture that shows it
  Tally gaps;                  // seconds between pictures of walkers
  double keyframes = 0;        // drawn, in the mean
  double least_keyframes = 0;  // whoever got the fewest had these
  double pictures = 0;         // arrived, in the mean
  double samples = 0;          // traced, in the mean
  double bytes = 0;            // a second of one visitor, in the mean over all its time
  double most_bytes = 0;       // a second of whoever takes the most
  double total_bytes = 0;      // a second of all
  double renderer = 0, tick = 0, cores = 0, network = 0;  // shares that are busy
  double line = 0;                                        // share of the busiest visitor's line
  int most_connections = 0;                               // one server had
};

// Returns what is wrong with what it is told ("bandwidth has to be more than 0"); empty: nothing.
std::string find_fault(const Demand& demand, const Fleet& fleet, const Span& span);

// Throws std::invalid_argument with that fault.
Outcome simulate(const Costs& costs, const Demand& demand, const Fleet& fleet, const Span& span);

}  // namespace wellspring::plan
