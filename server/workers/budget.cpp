// SPDX-License-Identifier: Apache-2.0
#include "workers/budget.h"

#include <algorithm>

namespace wellspring::workers {
namespace {

constexpr double weight = 0.2;  // share of a new measurement
constexpr double least_share = 0.05, more_share = 0.05, less_share = 0.7;
constexpr double longest_line = 2;                  // seconds
constexpr int least_part = 256, most_order = 2048;  // requests

void smooth_towards(double& value, double measured) { value += weight * (measured - value); }

void land(WorkerPace& pace, int requests, bool rests) {
  const uint64_t count = uint64_t(std::max(requests, 0));
  pace.in_flight -= std::min(pace.in_flight, count);
  if (!rests) pace.urgent -= std::min(pace.urgent, count);
}

}  // namespace

int room_for(const WorkerPace& pace, bool rests) {
  if (pace.rate <= 0) return pace.in_flight == 0 ? first_order : 0;
  const double seconds = pace.line + (rests ? ahead_resting : ahead_walking);
  const double ahead = std::min(pace.rate * pace.share * seconds, 1e6);
  return std::max(int(ahead - double(rests ? pace.in_flight : pace.urgent)), 0);
}

std::vector<OrderPlan> share_out(std::span<const int> rooms, int most) {
  const auto has_less = [](const OrderPlan& a, const OrderPlan& b) {
    return a.requests != b.requests ? a.requests < b.requests : a.worker > b.worker;
  };
  std::vector<OrderPlan> left;  // a heap of rooms
  for (size_t i = 0; i < rooms.size(); i++)
    if (rooms[i] >= least_order) left.push_back({i, rooms[i]});
  std::ranges::make_heap(left, has_less);
  std::vector<OrderPlan> plan;
  const int workers = std::max(int(left.size()), 1);
  const int part = std::clamp(most / workers, least_part, most_order);
  while (!left.empty() && most >= least_order) {
    std::ranges::pop_heap(left, has_less);
    OrderPlan& next = left.back();
    const int size = std::min({next.requests, most, part});
    plan.push_back({next.worker, size});
    most -= size, next.requests -= size;
    if (next.requests >= least_order) std::ranges::push_heap(left, has_less);
    else left.pop_back();
  }
  return plan;
}

void note_sent(WorkerPace& pace, int requests, bool rests) {
  pace.in_flight += uint64_t(requests);
  if (!rests) pace.urgent += uint64_t(requests);
}

void note_answered(WorkerPace& pace, int requests, bool rests, double whole, double waited,
                   double traced) {
  land(pace, requests, rests);
  if (traced > 0) {
    const double rate = double(requests) / traced;
    if (pace.rate <= 0) pace.rate = rate;
    else smooth_towards(pace.rate, rate);
  }
  smooth_towards(pace.line, std::clamp(whole - waited - traced, 0.0, longest_line));
  // Orders that wait for longer than this server's own would have to are behind those of others.
  const double most = pace.line + (rests ? ahead_resting : ahead_walking);
  if (waited > most) pace.share = std::max(pace.share * less_share, least_share);
  else pace.share = std::min(pace.share + more_share, 1.0);
}

void note_unanswered(WorkerPace& pace, int requests, bool rests) {
  land(pace, requests, rests);
  pace.share = std::max(pace.share * less_share, least_share);
}

void note_called(WorkerPace& pace, double whole) {
  smooth_towards(pace.line, std::clamp(whole, 0.0, longest_line));
}

}  // namespace wellspring::workers
