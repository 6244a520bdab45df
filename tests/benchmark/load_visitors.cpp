// SPDX-License-Identifier: Apache-2.0
// load.visitors: so many visitors stroll through the castle at once, at 640x360 over loopback, each
// let in whether its pictures will come quickly or not; they share the cores with the server.
// Pictures a second of each, the least over the most, the longest time that anybody was without
// one, and the time from an input to its picture, of all.
#include <algorithm>

#include "report.h"
#include "stream_server.h"
#include "stroll.h"

namespace wellspring::test {
namespace {

constexpr int crowd_width = 640, crowd_height = 360;

void measure(BenchReport& report, const BenchOptions& options, int visitors) {
  ServerProcess server(options, "castle");
  const std::vector<Stroll> seen = stroll_together(
      {server.port, crowd_width, crowd_height, 3, options.quick ? 6.0 : 20.0}, visitors);
  std::vector<double> rates, latencies, gaps;
  for (const Stroll& one : seen) {
    rates.push_back(one.fps());
    latencies.insert(latencies.end(), one.latencies.begin(), one.latencies.end());
    for (double gap : one.gaps()) gaps.push_back(gap);
  }
  const auto [least, most] = std::ranges::minmax(rates);
  nlohmann::json where = {{"scene", "castle"}, {"size", "640x360"}, {"visitors", visitors}};
  report.add("load.visitors.fps", quantile(rates, 0.5), "1/s", where);
  report.add("load.visitors.fairness", most > 0 ? least / most : 0, "", where);
  report.add("load.visitors.latency_p50_ms", quantile(latencies, 0.5), "ms", where);
  report.add("load.visitors.latency_p95_ms", quantile(latencies, 0.95), "ms", where);
  report.add("load.visitors.longest_gap_ms", quantile(gaps, 1), "ms", where);
  report.add("load.visitors.server_memory", server.resident() / (1 << 20), "MiB", where);
}

}  // namespace

void bench_load_visitors(BenchReport& report, const BenchOptions& options) {
  BenchOptions all = options;
  // Everybody is let in, at however few pictures.
  if (all.server_words.empty())
    all.server_words = {"--least-fps", "0.01", "--max-visitors", "1000"};
  for (int visitors : {1, 2, 4, 8, 16, 32}) measure(report, all, visitors);
}

}  // namespace wellspring::test
