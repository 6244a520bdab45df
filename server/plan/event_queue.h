// SPDX-License-Identifier: Apache-2.0
// Holds what is going to happen, by time; what happens at the same time, in the order in which it
// was planned, so that a simulation is the same each time it is run.
#pragma once
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include "base/layers.h"

namespace wellspring::plan {

template <class Event>
class EventQueue {
 public:
  void push(double time, Event event) { events_.push({time, count_++, std::move(event)}); }
  bool empty() const { return events_.empty(); }
  double next_time() const { return events_.top().time; }  // seconds; of a queue that is not empty
  Event pop() {
    Event event = events_.top().event;
    events_.pop();
    return event;
  }

 private:
  struct Entry {
    double time;
    uint64_t order;
    Event event;
    bool operator<(const Entry& other) const {
      return std::pair(time, order) > std::pair(other.time, other.order);
    }
  };
  std::priority_queue<Entry> events_;
  uint64_t count_ = 0;
};

}  // namespace wellspring::plan
