// SPDX-License-Identifier: Apache-2.0
#include "plan/simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>
#include <stdexcept>

#include "base/rng.h"
#include "plan/server_model.h"

namespace wellspring::plan {
namespace {

class Simulation {
 public:
  Simulation(const Costs& costs, const Demand& demand, const Fleet& fleet, const Span& span)
      : demand_(demand),
        span_(span),
        hall_{.costs = costs, .demand = demand_, .machine = fleet.machine},
        random_(span.seed) {
    if (fleet.workers > 0)
      hall_.worker_samples =
          fleet.workers * fleet.worker_cores * costs.samples / std::max(fleet.servers, 1);
    hall_.worker_trip = fleet.worker_trip;
    for (int i = 0; i < fleet.servers; i++) servers_.emplace_back(i, hall_);
    hall_.guests.resize(size_t(demand.visitors));
  }

  Outcome run() {
    // They come one after the other within a moment, so that their ticks are no chorus.
    for (int i = 0; i < demand_.visitors; i++)
      hall_.events.push(uniform(), {EventKind::leave, -1, i, 0});
    const double ends = span_.warm_up + span_.seconds;
    while (!hall_.events.empty() && hall_.events.next_time() < ends) {
      const double now = hall_.events.next_time();
      if (!counts_ && now >= span_.warm_up) begin_counting();
      happen(hall_.events.pop(), now);
    }
    if (!counts_) begin_counting();
    for (const Guest& one : hall_.guests) note_walk(one, ends);
    return sum_up(ends);
  }

 private:
  double uniform() { return double(random_.uniform()); }
  Guest& guest(int index) { return hall_.guests[size_t(index)]; }

  void begin_counting() {
    counts_ = true;
    for (ServerModel& server : servers_) server.begin_counting(span_.warm_up);
    for (Guest& one : hall_.guests) one.turned_at = std::max(one.turned_at, span_.warm_up);
  }

  void happen(const Event& event, double now) {
    switch (event.kind) {
      case EventKind::tick: return servers_[size_t(event.server)].tick(event.number, now);
      case EventKind::work: return servers_[size_t(event.server)].work(event.number, now);
      case EventKind::arrival: return arrive(event, now);
      case EventKind::acknowledged:
        if (guest(event.guest).visit == event.number) guest(event.guest).in_flight--;
        return;
      case EventKind::turn:
        if (guest(event.guest).visit == event.number) turn(event.guest, now);
        return;
      case EventKind::leave: return replace(event.guest, now);
    }
  }

  // Lets somebody come in the place of whoever was there.
  void replace(int index, double now) {
    Guest& one = guest(index);
    if (one.server >= 0) {
      note_walk(one, now);
      servers_[size_t(one.server)].leave(index, now);
    }
    Guest next;
    next.visit = one.visit + 1;
    next.counted = one.counted;
    next.phase = 60 * uniform();
    next.came_at = now;
    const auto server = std::ranges::min_element(
        servers_, {}, [](const ServerModel& model) { return model.connections(); });
    next.server = int(server - servers_.begin());
    one = next;
    turn(index, now);
    server->come(index, now);
    if (demand_.stay > 0)
      hall_.events.push(now - demand_.stay * std::log(1 - uniform()),
                        {EventKind::leave, -1, index, 0});
  }

  void note_walk(const Guest& one, double now) {
    if (counts_ && one.doing == Doing::walks && one.server >= 0)
      walked_[size_t(&one - hall_.guests.data())] += now - one.turned_at;
  }

  // Walks, stands and rests, as far into its turn as the visitor is.
  void turn(int index, double now) {
    Guest& one = guest(index);
    if (one.turned_at > 0 || one.doing != Doing::walks) note_walk(one, now);
    one.turned_at = now;
    const double walks = demand_.walking * demand_.turn;
    const double stands = std::min(walks + demand_.standing * demand_.turn, demand_.turn);
    const double at = std::fmod(now + one.phase, demand_.turn);
    const bool always = demand_.walking >= 1 || demand_.standing >= 1;
    const Doing before = one.doing;
    double next = demand_.turn;
    if (at < walks || demand_.walking >= 1) one.doing = Doing::walks, next = walks;
    else if (at < stands) one.doing = Doing::stands, next = stands;
    else one.doing = Doing::rests;
    if (one.doing == Doing::stands) one.stood_at = now;
    if (one.doing == Doing::walks && before != Doing::walks) {
      one.shown_seq = int((now - one.came_at) / demand_.input_interval);
      one.arrived_at = -1;
    }
    if (!always)
      hall_.events.push(now + std::max(next - at, 1e-6), {EventKind::turn, -1, index, one.visit});
  }

  void arrive(const Event& event, double now) {
    Guest& one = guest(event.guest);
    if (one.visit != event.number) return;
    hall_.events.push(now + demand_.latency,
                      {EventKind::acknowledged, -1, event.guest, event.number});
    if (event.seq < 0) return;
    const bool counts = counts_ && one.doing == Doing::walks;
    if (counts && event.seq > one.shown_seq) {
      for (int seq = one.shown_seq + 1; seq <= event.seq; seq++)
        outcome_.latency.add(now - one.came_at - seq * demand_.input_interval);
    }
    if (counts && one.arrived_at >= 0) outcome_.gaps.add(now - one.arrived_at);
    if (counts) one.counted.pictures++;
    one.arrived_at = now;
    one.shown_seq = std::max(one.shown_seq, event.seq);
  }

  Outcome sum_up(double ends) {
    const double seconds = span_.seconds;
    double walked = 0;
    outcome_.least_keyframes = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < hall_.guests.size(); i++) {
      const GuestCounts& one = hall_.guests[i].counted;
      walked += walked_[i];
      outcome_.keyframes += double(one.keyframes);
      outcome_.pictures += double(one.pictures);
      outcome_.samples += one.samples;
      outcome_.total_bytes += one.bytes / seconds;
      outcome_.most_bytes = std::max(outcome_.most_bytes, one.bytes / seconds);
      // A moment's walk says nothing of a rate.
      if (walked_[i] > 0.25 * seconds * demand_.walking)
        outcome_.least_keyframes =
            std::min(outcome_.least_keyframes, double(one.keyframes) / walked_[i]);
    }
    if (!std::isfinite(outcome_.least_keyframes)) outcome_.least_keyframes = 0;
    for (double* rate : {&outcome_.keyframes, &outcome_.pictures, &outcome_.samples})
      *rate = walked > 0 ? *rate / walked : 0;
    if (demand_.visitors > 0) outcome_.bytes = outcome_.total_bytes / demand_.visitors;
    outcome_.line = outcome_.most_bytes / demand_.bandwidth;
    for (ServerModel& server : servers_) {
      auto most = [](double& value, double other) { value = std::max(value, other); };
      most(outcome_.renderer, server.rendered() / seconds);
      most(outcome_.tick, server.ticked() / seconds);
      most(outcome_.cores, server.used(ends) / seconds / hall_.machine.cores);
      most(outcome_.network, server.sent() / seconds / hall_.machine.bandwidth);
      outcome_.most_connections = std::max(outcome_.most_connections, server.connections());
    }
    return outcome_;
  }

  const Demand demand_;
  const Span span_;
  Hall hall_;
  std::deque<ServerModel> servers_;
  Rng random_;
  bool counts_ = false;
  std::vector<double> walked_ = std::vector<double>(size_t(demand_.visitors));
  Outcome outcome_;
};

}  // namespace

std::string find_fault(const Demand& demand, const Fleet& fleet, const Span& span) {
  struct Rule {
    const char* name;
    double value, low, high;
  };
  const Machine& machine = fleet.machine;
  const Rule rules[] = {
      {"visitors", double(demand.visitors), 0, 1e6},
      {"the share that walks", demand.walking, 0, 1},
      {"the share that stands", demand.standing, 0, 1},
      {"the shares that walk and stand", demand.walking + demand.standing, 0, 1.000001},
      {"pixels", demand.pixels, 64, 1e8},
      {"the line's latency", demand.latency, 0, 10},
      {"the line's bandwidth", demand.bandwidth, 1e3, 1e12},
      {"the time of a visit", demand.stay, 0, 1e6},
      {"the time of a turn", demand.turn, 0.1, 1e5},
      {"the time between inputs", demand.input_interval, 1e-3, 10},
      {"servers", double(fleet.servers), 1, 1e6},
      {"cores", machine.cores, 0.1, 4096},
      {"the network's bandwidth", machine.bandwidth, 1e3, 1e13},
      {"memory", machine.memory, 0, 1e15},
      {"threads of other programs", machine.others, 0, 1e5},
      {"workers", double(fleet.workers), 0, 1e6},
      {"a worker's cores", fleet.worker_cores, 0, 4096},
      {"a worker's round trip", fleet.worker_trip, 0, 10},
      {"the time to warm up", span.warm_up, 0, 1e5},
      {"the simulated time", span.seconds, 0.1, 1e5}};
  for (const Rule& rule : rules) {
    if (rule.value >= rule.low && rule.value <= rule.high) continue;  // false for NaN
    char text[160];
    std::snprintf(text, sizeof text, "%s: has to be from %g to %g, and is %g", rule.name, rule.low,
                  rule.high, rule.value);
    return text;
  }
  return {};
}

Outcome simulate(const Costs& costs, const Demand& demand, const Fleet& fleet, const Span& span) {
  if (const std::string fault = find_fault(demand, fleet, span); !fault.empty())
    throw std::invalid_argument(fault);
  return Simulation(costs, demand, fleet, span).run();
}

}  // namespace wellspring::plan
