// SPDX-License-Identifier: Apache-2.0
// Tells how a server's workers are, and why they refuse.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/layers.h"

namespace wellspring::workers {

// Says why there are no samples.
enum class Refusal : uint8_t {
  none,
  version,       // another version of the program
  instructions,  // another instruction set
  exhibit,       // this worker has no such exhibit
  scene,         // its files differ
  light,         // its illumination maps differ
  state,         // its lamps or moving things cannot be put so
  technique,     // unknown, or one of passes over a picture
  late,          // the answer would not be worth having any more
  busy,          // too much waits here
  fetching,      // its exhibit or maps are on their way from the server, or being loaded
  disk,          // its disk has no room for the files that it fetches
};
inline constexpr int refusals = 12;
const char* to_word(Refusal refusal);

// Holds how a worker is, for who looks after it.
struct WorkerReport {
  std::string name, problem;  // why it is not asked at the moment; empty: it is
  bool same_bits = true;      // it has the server's instructions
  int cores = 0;
  double samples_per_second = 0, line = 0, share = 1;  // budget.h
  uint64_t in_flight = 0, samples = 0;                 // requests sent; samples that came
  uint64_t lost = 0;                                   // requests without a good answer in time
};

// Counts since the beginning.
struct CrewTotals {
  // Each request becomes a sample, is lost or is refused; the others are on the way.
  uint64_t orders = 0, requests = 0;     // sent
  uint64_t samples = 0;                  // samples that came, were right and in time
  uint64_t lost = 0;                     // requests without a good answer in time
  uint64_t dropped = 0;                  // messages that the line did not take
  uint64_t late = 0;                     // samples that came after that
  uint64_t spoiled = 0;                  // messages that were none, or whose samples cannot be
  uint64_t verified = 0, differing = 0;  // samples compared; those that differ
  // Samples of workers with other instructions, which differ in bits: how many were compared, the
  // sum of their light, and of its differences from ours and of the squares of these.
  uint64_t alike = 0;
  double alike_light = 0, alike_difference = 0, alike_squares = 0;
  // Returns by how many standard errors the mean difference is off zero: a test that their light is
  // the same (paired t-test).
  double alike_deviation() const;
  uint64_t refused[refusals] = {};  // requests, by reason
};

struct CrewReport {
  bool used = false, connected = false;  // there is an address; a NATS server answers there
  CrewTotals totals;
  std::vector<WorkerReport> workers;
};

}  // namespace wellspring::workers
