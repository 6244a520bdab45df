// SPDX-License-Identifier: Apache-2.0
// load.plan: what serving costs, whether the simulation of `wellspring plan` says from that what 1
// to 16 visitors then see of one server, and what it says for museums. Visitors stroll through the
// castle and share the cores with the server and with other programs, which are counted and told
// to the simulation.
#include <cmath>
#include <thread>

#include "crowd.h"
#include "plan/sizing.h"
#include "plan_costs.h"
#include "plot.h"

namespace wellspring::test {
namespace {

struct Size {
  int width, height;
};
constexpr Size checked[] = {{320, 180}, {640, 360}};
constexpr int crowd_sizes[] = {1, 2, 4, 8, 16};
constexpr Span simulated{4, 40, 1};

Outcome predict(const Costs& costs, const CrowdPlan& plan, const CrowdSeen& seen) {
  Demand demand;
  demand.visitors = plan.visitors;
  demand.pixels = double(plan.width) * plan.height;
  demand.local = plan.local;
  demand.bandwidth = 1e9;  // loopback
  Fleet fleet;
  fleet.machine.cores = costs.cores;
  fleet.machine.bandwidth = 1e10;
  fleet.machine.others = seen.others;
  return simulate(costs, demand, fleet, simulated);
}

void check(BenchReport& report, const BenchOptions& options, const Costs& costs,
           const CrowdPlan& plan) {
  const CrowdSeen seen = measure_crowd(options, plan);
  const Outcome said = predict(costs, plan, seen);
  const nlohmann::json where = {
      {"scene", "castle"},
      {"size", std::to_string(plan.width) + "x" + std::to_string(plan.height)},
      {"visitors", plan.visitors},
      {"display", plan.local ? "local" : "server"}};
  auto both = [&](const std::string& name, double measured, double simulated, const char* unit) {
    report.add("load.plan." + name, measured, unit, where);
    report.add("load.plan." + name + "_said", simulated, unit, where);
    report.add("load.plan." + name + "_ratio", simulated / measured, "", where);
  };
  both("p50", quantile(seen.latencies, 0.5), 1000 * said.latency.quantile(0.5), "ms");
  both("p95", quantile(seen.latencies, 0.95), 1000 * said.latency.quantile(0.95), "ms");
  both("keyframes", seen.keyframes, said.keyframes, "1/s");
  both("pictures", seen.pictures, said.pictures, "1/s");
  report.add("load.plan.others", seen.others, "", where);
}

// Curves of the time from an input to its picture, over the visitors of one server.
void draw_curves(BenchReport& report, const BenchOptions& options, const Costs& costs) {
  Plot plot{"Time from an input to its picture over visitors of one server",
            "simulated, all walk, 1280x720, pages draw by themselves; 95th percentile",
            "visitors who walk",
            "milliseconds",
            {},
            1000,
            "goal"};
  for (const double cores : {2.0, 8.0, 32.0}) {
    Curve curve{std::to_string(int(cores)) + " cores", {}};
    for (int visitors = 1; visitors <= 128; visitors *= 2) {
      Demand demand{.visitors = visitors, .pixels = 1280.0 * 720, .local = true, .latency = 0.005};
      Fleet fleet;
      fleet.machine.cores = cores;
      const Outcome said = simulate(costs, demand, fleet, simulated);
      const double p95 = 1000 * said.latency.quantile(0.95);
      curve.points.push_back({visitors, p95});
      report.add("load.plan.curve", p95, "ms", {{"cores", cores}, {"visitors", visitors}});
    }
    plot.curves.push_back(curve);
  }
  save_svg(options.plots + "load_plan.svg", plot);
}

// Says what to buy for visitors at the peak, half of whose time is walked.
void size_museums(BenchReport& report, const Costs& costs) {
  for (const double cores : {2.0, 8.0, 32.0})
    for (const int visitors : {100, 1000, 10000}) {
      Demand demand{.visitors = visitors,
                    .walking = 0.5,
                    .standing = 0.4,
                    .pixels = 1280.0 * 720,
                    .local = true,
                    .latency = 0.005,
                    .bandwidth = 12.5e6,
                    .stay = 900};
      const Machine machine{.cores = cores};
      const Sizing sizing = size_fleet(costs, demand, machine, {}, cores, 0.002);
      const nlohmann::json where = {{"cores", cores},
                                    {"visitors", visitors},
                                    {"gives_out", sizing.limit.part},
                                    {"goal", sizing.limit.goal}};
      report.add("load.plan.servers", sizing.servers, "", where);
      report.add("load.plan.each", sizing.each, "", where);
      report.add("load.plan.memory", sizing.memory / double(1 << 30), "GiB", where);
      report.add("load.plan.museum_line", 8e-6 * sizing.bandwidth, "Mbit/s", where);
      report.add("load.plan.expected_p95", 1000 * sizing.outcome.latency.quantile(0.95), "ms",
                 where);
      report.add("load.plan.expected_keyframes", sizing.outcome.keyframes, "1/s", where);
    }
}

}  // namespace

void bench_load_plan(BenchReport& report, const BenchOptions& options) {
  measure_plan_costs(report, options);
  const Costs costs = read_costs(report.to_json(), "load.plan");
  for (const bool local : {true, false})
    for (const Size& size : checked)
      for (const int visitors : crowd_sizes)
        check(report, options, costs,
              {.visitors = visitors,
               .width = size.width,
               .height = size.height,
               .local = local,
               .seconds = options.quick ? 8.0 : 20.0});
  draw_curves(report, options, costs);
  size_museums(report, costs);
}

}  // namespace wellspring::test
