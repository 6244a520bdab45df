// SPDX-License-Identifier: Apache-2.0
// Decides how many requests a worker is sent, by what was measured: how fast it traces, how long
// the line takes there and back, and how long orders wait for it, which tells what other servers
// ask of it. Pure functions of what is given; no clock.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/layers.h"

namespace wellspring::workers {

struct WorkerPace {
  double rate = 0;     // samples a second while it traces; 0: not known yet
  double line = 0.05;  // seconds there and back, without waiting and tracing
  double share = 1;    // part of its time that this server may count on
  // Requests sent and not answered: of walking visitors, which come first there; of all.
  uint64_t urgent = 0, in_flight = 0;
};

inline constexpr int first_order = 256;  // requests of the first order, which measures
// Seconds of its work that a worker may have before it, so that it is never idle while a picture is
// planned, and answers are not old. Pictures at rest come rarely, and are in no hurry.
inline constexpr double ahead_walking = 0.2, ahead_resting = 0.6;

// Returns how many more requests may be sent now; `rests`: of pictures at rest.
int room_for(const WorkerPace& pace, bool rests);

// Says how many requests one order has, and whose it is.
struct OrderPlan {
  size_t worker = 0;  // place in `rooms`
  int requests = 0;
};
inline constexpr int least_order = 64;  // requests
// Shares at most `most` requests out to workers that have so much room, so that all have some: who
// has most room is next, and the others keep theirs for what comes soon. Takes O(workers + orders *
// log(workers)).
std::vector<OrderPlan> share_out(std::span<const int> rooms, int most);

// Note what was sent, and what became of it. Times are seconds: from sending to the answer's
// arrival, of waiting at the worker, of tracing there.
void note_sent(WorkerPace& pace, int requests, bool rests);
void note_answered(WorkerPace& pace, int requests, bool rests, double whole, double waited,
                   double traced);
// Requests were lost, refused or given up.
void note_unanswered(WorkerPace& pace, int requests, bool rests);
void note_called(WorkerPace& pace, double whole);  // a call was answered

}  // namespace wellspring::workers
