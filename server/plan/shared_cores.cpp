// SPDX-License-Identifier: Apache-2.0
#include "plan/shared_cores.h"

#include <algorithm>
#include <limits>

namespace wellspring::plan {

namespace {
constexpr double nothing = 1e-9;  // seconds that rounding may leave
}

double width_on(double cores, double serial) {
  return cores <= 1 ? cores : 1 / (serial + (1 - serial) / cores);
}

double SharedCores::speed() const { return width_ > free_ ? free_ / width_ : 1; }

double SharedCores::seconds_left(const Task& task) const {
  return task.timed ? task.left : task.left / (task.width * speed());
}

void SharedCores::advance(double now) {
  const double seconds = std::max(now - at_, 0.0), part = speed();
  used_ += seconds * width_ * part;
  for (Task& task : tasks_) task.left -= task.timed ? seconds : seconds * task.width * part;
  at_ = std::max(at_, now);
}

void SharedCores::add(int id, double core_seconds, double width, double now) {
  advance(now);
  tasks_.push_back({id, std::max(core_seconds, 0.0), std::min(width, cores_), false});
  width_ += tasks_.back().width;
}

void SharedCores::hold(int id, double seconds, double width, double now) {
  advance(now);
  tasks_.push_back({id, std::max(seconds, 0.0), std::min(width, cores_), true});
  width_ += tasks_.back().width;
}

double SharedCores::next_end() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Task& task : tasks_) least = std::min(least, seconds_left(task));
  return at_ + std::max(least, 0.0);
}

int SharedCores::finish(double now) {
  advance(now);
  for (auto task = tasks_.begin(); task != tasks_.end(); ++task) {
    if (seconds_left(*task) > nothing) continue;
    const int id = task->id;
    tasks_.erase(task);
    width_ = 0;
    for (const Task& one : tasks_) width_ += one.width;
    return id;
  }
  return -1;
}

}  // namespace wellspring::plan
