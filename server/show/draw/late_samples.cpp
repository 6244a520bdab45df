// SPDX-License-Identifier: Apache-2.0
#include "show/draw/late_samples.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/clock.h"
#include "cache/trace_waiting.h"

namespace wellspring {

bool order_samples(Show& show) {
  Easel& easel = show.easel;
  easel.brokers.clear();
  easel.seconds = 0;
  for (Visitor& visitor : show.visitors) {
    if (visitor.picture.broker_seconds <= 0) continue;
    easel.brokers.push_back(&visitor.picture.broker);
    easel.seconds += std::exchange(visitor.picture.broker_seconds, 0.0);
    visitor.picture.at_work = true;
  }
  return !easel.brokers.empty();
}

void trace_samples(const Show& show, Easel& easel) {
  std::mutex guard;
  double began = seconds_now();
  easel.traced = trace_waiting(easel.brokers, *show.world, show.lights, show.pose_number,
                               began + easel.seconds, guard);
  easel.traced_seconds = seconds_now() - began;
}

void finish_samples(Show& show) {
  Easel& easel = show.easel;
  show.totals.samples += easel.traced;
  if (easel.traced > 0 && easel.traced_seconds > 0)
    smooth(show.samples_per_second, float(double(easel.traced) / easel.traced_seconds));
  for (Visitor& visitor : show.visitors) {
    auto found = std::find(easel.brokers.begin(), easel.brokers.end(), &visitor.picture.broker);
    if (found == easel.brokers.end()) continue;
    smooth(visitor.times.trace, float(1000 * easel.traced_seconds / double(easel.brokers.size())));
    visitor.picture.at_work = false;
  }
  easel.brokers.clear();
}

}  // namespace wellspring
