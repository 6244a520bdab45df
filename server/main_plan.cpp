// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring plan --visitors N`: how many machines a museum needs. Exit status: 0 done, 1 the
// input is wrong, 2 the command line is wrong.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fmt/core.h>
#include <iostream>
#include <nlohmann/json.hpp>

#include "about/version.h"
#include "base/log.h"
#include "plan/sizing.h"

namespace wellspring::program {
namespace {

struct Options {
  std::string costs, size = "1280x720", display = "local";
  int visitors = 0;
  double peak = 1, walking = 0.5, standing = 0.4;
  double latency_ms = -1, rate = -1, samples = 0;
  double line_ms = 10, line_mbit = 100, network_mbit = 1000, stay_minutes = 15;
  double cores = 0, memory_gib = 0, worker_cores = 0, worker_trip_ms = 2;
  bool json = false;
};

constexpr double bytes_in_megabit = 125e3, gib = double(1 << 30);

// Says wrong use of the command line.
struct WrongOption : std::runtime_error {
  using std::runtime_error::runtime_error;
};

Demand read_demand(const Options& options) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(options.size.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 16 ||
      height < 16 || width > 8192 || height > 8192)
    throw WrongOption("--size wants WIDTHxHEIGHT, such as 1280x720");
  if (options.walking + options.standing > 1.000001)
    throw WrongOption("--walking and --standing are shares of a visit: together at most 1");
  Demand demand;
  demand.visitors = visitors_at_peak(options.visitors, options.peak);
  demand.walking = options.walking, demand.standing = options.standing;
  demand.pixels = double(width) * height;
  demand.local = options.display == "local";
  demand.latency = 0.001 * options.line_ms / 2;
  demand.bandwidth = options.line_mbit * bytes_in_megabit;
  demand.stay = 60 * options.stay_minutes;
  return demand;
}

nlohmann::ordered_json to_json(const Options& options, const Machine& machine, const Goals& goals,
                               double worker_cores, const Sizing& sizing) {
  const Outcome& outcome = sizing.outcome;
  auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  return {{"visitors", options.visitors},
          {"at_peak", sizing.peak},
          {"size", options.size},
          {"display", options.display},
          {"goals",
           {{"rate", goals.rate},
            {"latency_p95_ms", 1000 * goals.latency},
            {"samples_a_second", goals.samples}}},
          {"servers",
           {{"machines", sizing.servers},
            {"cores_each", machine.cores},
            {"cores", sizing.servers * machine.cores},
            {"memory_bytes_each", sizing.memory},
            {"bytes_a_second_each", sizing.server_bandwidth},
            {"visitors_each_at_most", sizing.each}}},
          {"workers",
           {{"machines", sizing.workers},
            {"cores_each", worker_cores},
            {"cores", sizing.workers * worker_cores}}},
          {"lines",
           {{"bytes_a_second", sizing.bandwidth},
            {"bytes_a_second_of_a_visitor", sizing.line},
            {"lines", sizing.peak}}},
          {"expected",
           {{"latency_p50_ms", number(1000 * outcome.latency.quantile(0.5))},
            {"latency_p95_ms", number(1000 * outcome.latency.quantile(0.95))},
            {"keyframes_a_second", outcome.keyframes},
            {"pictures_a_second", outcome.pictures},
            {"samples_a_second", outcome.samples},
            {"busy",
             {{"renderer", outcome.renderer},
              {"tick", outcome.tick},
              {"cores", outcome.cores},
              {"network", outcome.network},
              {"line", outcome.line}}}}},
          {"first_limit", {{"goal", sizing.limit.goal}, {"part", sizing.limit.part}}}};
}

void tell(const Options& options, const Machine& machine, const Goals& goals, double worker_cores,
          const Sizing& sizing) {
  const Outcome& outcome = sizing.outcome;
  std::cout << fmt::format("{} visitors, of whom {} are there at the peak, at {} ({} display).\n",
                           options.visitors, sizing.peak, options.size, options.display);
  if (sizing.peak == 0) {
    std::cout << "Nobody is there, so no machine is needed.\n";
    return;
  }
  const double megabit = 1 / bytes_in_megabit;
  std::cout << fmt::format(
      "Servers: {} machines of {:g} cores, {} cores in all. Each keeps {} visitors content, and\n"
      "  needs {:.1f} GiB of memory and {:.1f} Mbit/s.\n",
      sizing.servers, machine.cores, sizing.servers * machine.cores, sizing.each,
      sizing.memory / gib, sizing.server_bandwidth * megabit);
  if (sizing.workers > 0)
    std::cout << fmt::format("Workers: {} machines of {:g} cores, {:g} cores in all.\n",
                             sizing.workers, worker_cores, sizing.workers * worker_cores);
  else std::cout << "Workers: none.\n";
  std::cout << fmt::format("Lines: {:.0f} Mbit/s in all, {:.1f} Mbit/s for each of {} visitors.\n",
                           sizing.bandwidth * megabit, sizing.line * megabit, sizing.peak);
  if (outcome.latency.count() > 0)
    std::cout << fmt::format(
        "Whoever walks then has {:.1f} keyframes and {:.1f} pictures a second; an input is seen "
        "after\n  {:.0f} ms (median) to {:.0f} ms (95th percentile). {:.0f} samples a second.\n",
        outcome.keyframes, outcome.pictures, 1000 * outcome.latency.quantile(0.5),
        1000 * outcome.latency.quantile(0.95), outcome.samples);
  if (!sizing.limit.goal.empty())
    std::cout << fmt::format(
        "One visitor more on a server would miss the goal of {}: its {} gives out first.\n",
        sizing.limit.goal, sizing.limit.part);
}

int run(const Options& options) {
  const Costs costs = load_costs(options.costs);
  const Demand demand = read_demand(options);
  Machine machine;
  machine.cores = options.cores > 0 ? options.cores : costs.cores;
  machine.bandwidth = options.network_mbit * bytes_in_megabit;
  machine.memory = options.memory_gib * gib;
  Goals goals;
  goals.rate = options.rate >= 0 ? options.rate : demand.local ? 3 : 15;
  goals.latency = options.latency_ms > 0 ? 0.001 * options.latency_ms : demand.local ? 1 : 0.12;
  goals.samples = options.samples;
  const double worker_cores = options.worker_cores > 0 ? options.worker_cores : machine.cores;
  const Sizing sizing =
      size_fleet(costs, demand, machine, goals, worker_cores, 0.001 * options.worker_trip_ms);
  if (options.json)
    std::cout << to_json(options, machine, goals, worker_cores, sizing).dump(2) << "\n";
  else tell(options, machine, goals, worker_cores, sizing);
  return 0;
}

}  // namespace
}  // namespace wellspring::program

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::program;
  if (answer_version(argc, argv)) return 0;
  log::start("plan");
  CLI::App app{
      "Says how many machines a museum needs, by a simulation of its servers with the costs that "
      "were measured on this machine."};
  Options options;
  app.add_option("--visitors", options.visitors, "visitors of the museum")
      ->required()
      ->check(CLI::Range(0, 1000000));
  app.add_option("--peak", options.peak, "share of them who are there at once, at the peak")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--bench", options.costs,
                 "costs: what ./wellspring bench --only load.plan --json FILE wrote")
      ->required();
  app.add_option("--size", options.size, "of their pictures")->capture_default_str();
  app.add_option("--display", options.display,
                 "local: pages draw by themselves, of keyframes; server: pictures come finished")
      ->check(CLI::IsMember({"local", "server"}))
      ->capture_default_str();
  app.add_option("--rate", options.rate,
                 "keyframes (local) or pictures a second for whoever walks; 3 or 15 without")
      ->check(CLI::Range(0.0, 120.0));
  app.add_option(
         "--latency", options.latency_ms,
         "milliseconds from an input to its picture, in 95 of 100 cases; 1000 or 120 without")
      ->check(CLI::Range(1.0, 60000.0));
  app.add_option("--samples", options.samples,
                 "samples of light a second for whoever walks: workers trace what servers do not")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--walking", options.walking, "share of a visit that is walked")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--standing", options.standing, "share that is stood; else the page is hidden")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--stay", options.stay_minutes, "minutes of a visit, in the mean")
      ->check(CLI::Range(0.1, 10000.0))
      ->capture_default_str();
  app.add_option("--line", options.line_mbit, "Mbit/s of a visitor's line")
      ->check(CLI::Range(0.01, 1e6))
      ->capture_default_str();
  app.add_option("--trip", options.line_ms, "milliseconds there and back on it")
      ->check(CLI::Range(0.0, 10000.0))
      ->capture_default_str();
  app.add_option("--cores", options.cores, "of a server; without it those of the measured machine")
      ->check(CLI::Range(0.1, 4096.0));
  app.add_option("--memory", options.memory_gib, "GiB that a server may use; without it any number")
      ->check(CLI::Range(0.1, 1e6));
  app.add_option("--network", options.network_mbit, "Mbit/s of a server's network")
      ->check(CLI::Range(0.01, 1e7))
      ->capture_default_str();
  app.add_option("--worker-cores", options.worker_cores,
                 "of a machine that only traces samples; without it those of a server")
      ->check(CLI::Range(0.1, 4096.0));
  app.add_option("--worker-trip", options.worker_trip_ms,
                 "milliseconds from a server to a worker and back")
      ->check(CLI::Range(0.0, 10000.0))
      ->capture_default_str();
  app.add_flag("--json", options.json, "fields instead of words");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return run(options);
  } catch (const WrongOption& error) {
    std::cerr << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
