// SPDX-License-Identifier: Apache-2.0
#include "plan/sizing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

namespace wellspring::plan {
namespace {

constexpr int most_visitors = 1000;      // one server takes no more (--max-visitors)
constexpr double one_in_twenty = 1.645;  // standard deviations of the normal distribution
constexpr Span trial{4, 16, 1}, whole{4, 12, 3};
constexpr double most_simulated = 6e4;  // visitor-seconds of the whole fleet

double rate_of(const Outcome& outcome, bool local) {
  return local ? outcome.keyframes : outcome.pictures;
}

// Returns the goal that is missed; empty: none.
std::string missed(const Outcome& outcome, const Demand& demand, const Goals& goals) {
  if (demand.walking <= 0) return "";  // nobody walks who could wait
  if (!(rate_of(outcome, demand.local) >= goals.rate)) return "rate";
  if (!(outcome.latency.quantile(0.95) <= goals.latency)) return "latency";
  return "";
}

class OneServer {
 public:
  OneServer(const Costs& costs, const Demand& demand, const Machine& machine, const Goals& goals)
      : costs_(costs), demand_(demand), goals_(goals), fleet_{.machine = machine} {}
  // Simulates one server with so many visitors, by itself or with workers of so many cores.
  Outcome with(int visitors, double worker_cores = 0, double trip = 0) const {
    Demand demand = demand_;
    demand.visitors = visitors;
    demand.stay = 0;
    Fleet fleet = fleet_;
    fleet.workers = worker_cores > 0;
    fleet.worker_cores = worker_cores, fleet.worker_trip = trip;
    return simulate(costs_, demand, fleet, trial);
  }
  double memory(int visitors) const {
    return costs_.server_memory + visitors * costs_.visitor_memory.at(demand_.pixels);
  }
  std::string fault(int visitors) const {
    if (fleet_.machine.memory > 0 && memory(visitors) > fleet_.machine.memory) return "memory";
    if (visitors > most_visitors) return "most visitors";
    return missed(with(visitors), demand_, goals_);
  }
  // Returns the most visitors without a fault, which more than one are sure to have.
  int most() const {
    int good = 1, bad = 2;
    while (bad <= most_visitors && fault(bad).empty()) good = bad, bad *= 2;
    while (bad - good > 1) {
      const int middle = (good + bad) / 2;
      (fault(middle).empty() ? good : bad) = middle;
    }
    return good;
  }

 private:
  const Costs& costs_;
  const Demand& demand_;
  const Goals& goals_;
  Fleet fleet_;
};

// Returns the part of a server that has the least left.
std::string busiest(const Outcome& outcome) {
  const std::pair<double, const char*> parts[] = {{outcome.renderer, "renderer"},
                                                  {outcome.tick, "tick"},
                                                  {outcome.cores, "cores"},
                                                  {outcome.network, "network"},
                                                  {outcome.line, "line"}};
  return std::ranges::max_element(parts)->second;
}

[[noreturn]] void refuse_alone(const Outcome& alone, const Demand& demand, const Goals& goals,
                               const std::string& fault, double memory) {
  char text[240];
  if (fault == "memory")
    std::snprintf(text, sizeof text, "one visitor alone needs a server of %.1f GB of memory",
                  1e-9 * memory);
  else
    std::snprintf(text, sizeof text,
                  "one visitor alone has %.2f %s a second within %.0f ms (95th percentile), and is "
                  "to have %.2f within %.0f: take smaller pictures, more cores or lower goals",
                  rate_of(alone, demand.local), demand.local ? "keyframes" : "pictures",
                  1000 * alone.latency.quantile(0.95), goals.rate, 1000 * goals.latency);
  throw std::invalid_argument(text);
}

// Returns the cores of workers that one server needs for its visitors' samples.
double cores_for_samples(const OneServer& server, int visitors, double samples, double trip) {
  auto reaches = [&](double cores) {
    return server.with(visitors, cores, trip).samples >= samples;
  };
  if (server.with(visitors).samples >= samples) return 0;
  double good = 1;
  while (!reaches(good)) {
    good *= 2;
    if (good > 4096)
      throw std::invalid_argument("no number of workers traces so many samples for a visitor");
  }
  double bad = good > 1 ? good / 2 : 0;
  for (int i = 0; i < 8; i++) {
    const double middle = 0.5 * (good + bad);
    (reaches(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace

int visitors_at_peak(int visitors, double share) {
  if (visitors < 0 || !(share >= 0 && share <= 1))
    throw std::invalid_argument("the share at the peak has to be from 0 to 1");
  const double mean = visitors * share;
  return int(
      std::min(std::ceil(mean + one_in_twenty * std::sqrt(mean * (1 - share))), double(visitors)));
}

Sizing size_fleet(const Costs& costs, const Demand& demand, const Machine& machine,
                  const Goals& goals, double worker_cores, double worker_trip) {
  const Fleet asked{.machine = machine, .worker_cores = worker_cores, .worker_trip = worker_trip};
  if (const std::string fault = find_fault(demand, asked, trial); !fault.empty())
    throw std::invalid_argument(fault);
  if (!(goals.rate >= 0 && goals.latency > 0 && goals.samples >= 0))
    throw std::invalid_argument("goals have to be numbers from 0, and the latency above it");
  Sizing sizing;
  sizing.peak = demand.visitors;
  if (demand.visitors == 0) return sizing;
  const OneServer server(costs, demand, machine, goals);
  if (const std::string fault = server.fault(1); !fault.empty())
    refuse_alone(server.with(1), demand, goals, fault, server.memory(1));
  sizing.each = server.most();
  sizing.limit.goal = server.fault(sizing.each + 1);
  sizing.limit.part = sizing.limit.goal == "memory" || sizing.limit.goal == "most visitors"
                          ? "memory"
                          : busiest(server.with(sizing.each + 1));
  sizing.servers = (demand.visitors + sizing.each - 1) / sizing.each;
  const int seated = (demand.visitors + sizing.servers - 1) / sizing.servers;
  if (goals.samples > 0) {
    const double cores = cores_for_samples(server, seated, goals.samples, worker_trip);
    if (cores > 0 && !(worker_cores > 0))
      throw std::invalid_argument(
          "workers need cores: so many samples take more than servers have");
    if (cores > 0) sizing.workers = int(std::ceil(cores * sizing.servers / worker_cores));
  }
  sizing.memory = server.memory(seated);
  Fleet fleet = asked;
  fleet.servers = sizing.servers, fleet.workers = sizing.workers;
  Span span = whole;
  span.seconds = std::clamp(most_simulated / demand.visitors, 1.0, whole.seconds);
  sizing.outcome = simulate(costs, demand, fleet, span);
  sizing.server_bandwidth = sizing.outcome.network * machine.bandwidth;
  sizing.bandwidth = sizing.outcome.total_bytes;
  sizing.line = sizing.outcome.most_bytes;
  return sizing;
}

}  // namespace wellspring::plan
