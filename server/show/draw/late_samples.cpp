// SPDX-License-Identifier: Apache-2.0
#include "show/draw/late_samples.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/clock.h"
#include "cache/trace_waiting.h"
#include "show/draw/pace.h"
#include "show/state/visitor_world.h"

namespace wellspring::show {

bool request_samples(Show& show) {
  Renderer& renderer = show.renderer;
  renderer.brokers.clear();
  renderer.seconds = 0;
  Visitor* first = nullptr;  // who sees another world waits for the next turn
  for (Visitor& visitor : show.visitors) {
    if (visitor.picture.broker_seconds <= 0) continue;
    if (!first) go_on_in_world_of(show, *(first = &visitor));
    else if (!see_the_same(show, *first, visitor)) continue;
    renderer.brokers.push_back(&visitor.picture.broker);
    renderer.seconds += std::exchange(visitor.picture.broker_seconds, 0.0);
    visitor.picture.at_work = true;
  }
  return !renderer.brokers.empty();
}

void trace_samples(const Show& show, Renderer& renderer) {
  std::mutex guard;
  double began = seconds_now();
  renderer.traced = trace_waiting(renderer.brokers, *show.world, show.lights, show.pose_number,
                                  began + renderer.seconds, guard);
  renderer.traced_seconds = seconds_now() - began;
}

void finish_samples(Show& show) {
  Renderer& renderer = show.renderer;
  show.totals.samples += renderer.traced;
  if (renderer.traced > 0 && renderer.traced_seconds > 0)
    smooth(show.samples_per_second, float(double(renderer.traced) / renderer.traced_seconds));
  for (Visitor& visitor : show.visitors) {
    auto found =
        std::find(renderer.brokers.begin(), renderer.brokers.end(), &visitor.picture.broker);
    if (found == renderer.brokers.end()) continue;
    smooth(visitor.times.trace,
           float(1000 * renderer.traced_seconds / double(renderer.brokers.size())));
    visitor.picture.at_work = false;
    visitor.picture.served +=
        renderer.traced_seconds / double(renderer.brokers.size()) * charge_weight(show, visitor);
  }
  renderer.brokers.clear();
}

}  // namespace wellspring::show
