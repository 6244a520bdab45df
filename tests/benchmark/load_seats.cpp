// SPDX-License-Identifier: Apache-2.0
// load.seats: how many keyframes visitors get whose pages draw by themselves, while all of them, or
// a third, stroll through the castle, and what the server says how many it seats. For comparison
// some whose pictures come finished. Everybody is let in; they share the cores with the server.
#include <algorithm>

#include "report.h"
#include "stream_server.h"
#include "stroll.h"

namespace wellspring::test {
namespace {

struct Crowd {
  int visitors, width, height;
  double walking;
  bool local;
};
constexpr Crowd crowds[] = {{1, 1280, 720, 1, true},        {4, 1280, 720, 1, true},
                            {8, 1280, 720, 1, true},        {20, 640, 360, 1, true},
                            {12, 1280, 720, 1.0 / 3, true}, {4, 1280, 720, 1, false}};

// If the crowd were larger, some of it would wait for a seat.
constexpr int most_seated = 8;

void measure(BenchReport& report, BenchOptions options, const Crowd& crowd) {
  const bool all_seated = crowd.local && crowd.visitors <= most_seated;
  if (options.server_words.empty())
    options.server_words = {"--max-visitors", "1000", "--least-fps", all_seated ? "15" : "0.01"};
  const ServerProcess server(options, "castle");
  const StrollPlan plan{.port = server.port,
                        .width = crowd.width,
                        .height = crowd.height,
                        .warm_up = 4,
                        .seconds = options.quick ? 9.0 : 27.0,
                        .walking = crowd.walking,
                        .local = crowd.local};
  const double before = server.core_seconds();
  const std::vector<Stroll> seen = stroll_together(plan, crowd.visitors);
  const double spent = (server.core_seconds() - before) / (plan.warm_up + plan.seconds);
  std::vector<double> rates, gaps, bytes;
  double sent = 0;
  for (const Stroll& one : seen) {
    rates.push_back(one.walked > 0 ? double(one.arrivals.size()) / one.walked : 0);
    for (double gap : one.gaps()) gaps.push_back(gap);
    for (double size : one.bytes) bytes.push_back(size), sent += size;
  }
  const auto [least, most] = std::ranges::minmax(rates);
  const nlohmann::json where = {
      {"scene", "castle"},
      {"size", std::to_string(crowd.width) + "x" + std::to_string(crowd.height)},
      {"visitors", crowd.visitors},
      {"walking", crowd.walking == 1 ? "all" : "a third"},
      {"display", crowd.local ? "local" : "server"}};
  report.add("load.seats.rate", quantile(rates, 0.5), "1/s", where);
  report.add("load.seats.least_rate", least, "1/s", where);
  report.add("load.seats.fairness", most > 0 ? least / most : 0, "", where);
  if (crowd.walking == 1) report.add("load.seats.longest_gap_ms", quantile(gaps, 1), "ms", where);
  report.add("load.seats.picture_bytes", quantile(bytes, 0.5), "B", where);
  report.add("load.seats.bandwidth", 8e-6 * sent / plan.seconds / crowd.visitors, "Mbit/s", where);
  report.add("load.seats.cores", spent, "", where);
  if (all_seated) report.add("load.seats.seats", read_metric(server.port, "seats"), "", where);
  report.add("load.seats.server_memory", server.resident() / (1 << 20), "MiB", where);
}

}  // namespace

void bench_load_seats(BenchReport& report, const BenchOptions& options) {
  for (const Crowd& crowd : crowds) measure(report, options, crowd);
}

}  // namespace wellspring::test
