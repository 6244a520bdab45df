// SPDX-License-Identifier: Apache-2.0
// How many machines a museum needs: the most visitors that one server keeps content, found by
// simulation, then servers, workers and lines for all who are there at the peak.
#pragma once
#include <string>

#include "plan/simulation.h"

namespace wellspring::plan {

// Says what everybody who walks is to have.
struct Goals {
  double rate = 3;     // keyframes a second, or finished pictures, in the mean
  double latency = 1;  // seconds from an input to its picture, in 95 of 100 cases
  double samples = 0;  // samples of light a second
};

// Which goal, or which part of a server, gives out first as visitors become more.
struct Limit {
  std::string goal;  // "rate", "latency", "memory", or "most visitors"
  std::string part;  // "renderer", "tick", "cores", "network", "line" or "memory"
};

struct Sizing {
  int peak = 0;                 // visitors at the peak
  int each = 0;                 // visitors whom one server keeps content, at most
  int servers = 0;              // machines
  int workers = 0;              // machines that only trace samples
  double memory = 0;            // bytes that a server needs, with as many as it gets
  double server_bandwidth = 0;  // bytes a second of the busiest server
  double bandwidth = 0;         // bytes a second of the museum
  double line = 0;              // bytes a second of whoever takes the most
  Outcome outcome;              // for all of them together; none for nobody
  Limit limit;                  // with one visitor more a server
};

// Returns how many of `visitors` are there at the peak, if each is with that chance, independently:
// the number that is exceeded in one case of twenty (normal approximation of the binomial).
int visitors_at_peak(int visitors, double share);

// Finds the machines. Demand::visitors are those at the peak; a worker has worker_cores. Throws
// std::invalid_argument that says what is wrong, or which goal one visitor alone does not reach.
Sizing size_fleet(const Costs& costs, const Demand& demand, const Machine& machine,
                  const Goals& goals, double worker_cores, double worker_trip);

}  // namespace wellspring::plan
