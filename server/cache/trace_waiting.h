// SPDX-License-Identifier: Apache-2.0
// The worker that is always there: all cores, for as long as the caller has time. Others may take
// pieces of the same brokers meanwhile only if they share its guard.
#pragma once
#include <mutex>
#include <span>

#include "cache/broker.h"
#include "light/sample/lights.h"

namespace wellspring::cache {

// Traces what waits, a piece of each broker in turn, until nothing does or it is later than `until`
// (as seconds_now(); a piece that was begun is finished). Returns how many samples were answered.
size_t trace_waiting(std::span<Broker* const> brokers, const World& world, const Lights& lights,
                     uint64_t pose, double until, std::mutex& guard);

}  // namespace wellspring::cache
