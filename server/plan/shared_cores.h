// SPDX-License-Identifier: Apache-2.0
// Simulates the cores of one machine, which its tasks share. A task has a width: how many cores it
// can use at once. While all widths together are more than there are cores, each task gets the same
// part of its width, as a fair scheduler of threads gives it (processor sharing, Kleinrock 1976,
// section 4.4). The measured costs include what the memory's bandwidth and caches take.
//
// A task that cores share badly, of which `serial` is done by one core alone, is narrower
// (Amdahl 1967).
#pragma once
#include <vector>

#include "base/layers.h"

namespace wellspring::plan {

// Returns by how many cores a task gets quicker on so many cores.
double width_on(double cores, double serial);

class SharedCores {
 public:
  // others: programs that want all cores at once; each gets as much as the server, as systemd's
  // services and sessions do by default (sched(7): autogroups, cgroups).
  explicit SharedCores(double cores, double others = 0)
      : cores_(cores), free_(cores / (1 + others)) {}
  // Begins a task of so many core-seconds. `now` never goes back.
  void add(int id, double core_seconds, double width, double now);
  // Begins a task that ends after so many seconds, whatever it has got by then.
  void hold(int id, double seconds, double width, double now);
  // Returns when the next task ends if none begins before; infinity: there is none.
  double next_end() const;
  // Ends a task that has nothing left at `now`, and returns its id; -1: none has.
  int finish(double now);
  // Returns the core-seconds that the tasks have got until `now`.
  double used(double now) { return advance(now), used_; }
  double cores() const { return cores_; }

 private:
  struct Task {
    int id;
    double left, width;  // core-seconds, or seconds if it is timed
    bool timed;
  };
  double speed() const;  // part of its width that each task gets
  double seconds_left(const Task& task) const;
  void advance(double now);
  const double cores_, free_;  // free_: that other programs leave
  std::vector<Task> tasks_;
  double width_ = 0;  // all tasks together
  double at_ = 0, used_ = 0;
};

}  // namespace wellspring::plan
