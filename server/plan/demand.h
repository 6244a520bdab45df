// SPDX-License-Identifier: Apache-2.0
// Who visits, over which lines, and what serves them: what a simulation is told.
#pragma once
#include <cstdint>

#include "base/layers.h"

namespace wellspring::plan {

// All visitors are alike. Times are in seconds.
struct Demand {
  int visitors = 1;     // at once
  double walking = 1;   // share of the time in which a visitor walks
  double standing = 0;  // and stands; in what is left the page is hidden, and nothing is drawn
  double turn = 9;      // seconds after which a visitor has walked, stood and rested
  double pixels = 640 * 360;  // a picture has
  bool local = false;         // pages draw by themselves, of keyframes with depth
  double input_interval = 1 / 30.0;
  double latency = 0;        // seconds that a visitor's line takes one way
  double bandwidth = 125e6;  // bytes a second of a visitor's line
  double stay = 0;           // a visit lasts, in the mean; then somebody else comes. 0: for ever
  bool operator==(const Demand&) const = default;
};

struct Machine {
  double cores = 2;
  double bandwidth = 125e6;  // bytes a second of its network
  double memory = 0;         // bytes that the server may use; 0: any number
  double others = 0;  // other programs that want all of its cores, each as much as the server
  bool operator==(const Machine&) const = default;
};

struct Fleet {
  int servers = 1;
  Machine machine;
  int workers = 0;             // machines that only trace samples
  double worker_cores = 0;     // each has
  double worker_trip = 0.002;  // seconds there and back
};

// Says how many seconds are simulated, and how many before them do not count.
struct Span {
  double warm_up = 4, seconds = 20;
  uint64_t seed = 1;
};

}  // namespace wellspring::plan
