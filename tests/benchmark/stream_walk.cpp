// SPDX-License-Identifier: Apache-2.0
// The whole way as a visitor has it: a server process, a scripted client that strolls through the
// castle at 1280x720 over loopback, and the time from sending an input to receiving the picture
// that shows it.
#include <stdexcept>

#include "base/clock.h"
#include "report.h"
#include "stream_line.h"
#include "stream_server.h"
#include "stroll.h"

namespace wellspring::test {

namespace {

// Results are called `name`.fps and so on.
void walk(BenchReport& report, const BenchOptions& options, const std::string& name) {
  ServerProcess server(options, "castle");
  StrollPlan plan;
  plan.port = server.port;
  plan.seconds = options.quick ? 6 : 20;
  const char* counters[] = {"pictures_drawn_total", "pictures_warped_total"};
  double counts_before[2] = {}, counted_from = 0;
  const Stroll seen = stroll_through(plan, [&] {
    for (size_t i = 0; i < 2; i++) counts_before[i] = read_metric(server.port, counters[i]);
    counted_from = seconds_now();
  });
  if (seen.arrivals.size() < 2) throw std::runtime_error("hardly any picture arrived");
  const double counted = seconds_now() - counted_from;
  nlohmann::json where = {{"scene", "castle"}, {"size", "1280x720"}};
  report.add(name + ".fps", seen.fps(), "1/s", where);
  report.add(name + ".drawn_fps",
             (read_metric(server.port, counters[0]) - counts_before[0]) / counted, "1/s", where);
  report.add(name + ".warped_fps",
             (read_metric(server.port, counters[1]) - counts_before[1]) / counted, "1/s", where);
  report.add(name + ".repeated", 100 * double(seen.repeated) / double(seen.arrivals.size()), "%",
             where);
  report.add(name + ".latency_p50_ms", quantile(seen.latencies, 0.5), "ms", where);
  report.add(name + ".latency_p95_ms", quantile(seen.latencies, 0.95), "ms", where);
  report.add(name + ".gap_p95_ms", quantile(seen.gaps(), 0.95), "ms", where);
  report.add(name + ".picture_bytes_p50", quantile(seen.bytes, 0.5), "B", where);
  report.add(name + ".server_memory", server.resident() / (1 << 20), "MiB", where);
}

}  // namespace

void bench_stream(BenchReport& report, const BenchOptions& options) {
  walk(report, options, "stream.walk");
  bench_line(report, options);
}

}  // namespace wellspring::test
