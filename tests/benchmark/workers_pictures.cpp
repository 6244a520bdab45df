// SPDX-License-Identifier: Apache-2.0
// What workers do to pictures: one at rest is good sooner, and none of who walks comes later,
// whatever the workers' lines do. Ways are measured in turn in one run, and compared within it.
#include <csignal>
#include <fmt/core.h>
#include <optional>
#include <stdexcept>

#include "base/clock.h"
#include "held_workers.h"
#include "shaped_line.h"
#include "show_visit.h"
#include "stroll.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

constexpr double worker_share = 0.25, resting_share = 0.25, walking_share = 0.5;  // cores
constexpr double trace_wait = 180, settling = 3;                                  // seconds
constexpr int small_width = 640, small_height = 360;
const std::string measured_exhibit = "first-room", measured_viewpoint = "vase";

BenchOptions with_workers(BenchOptions options, const std::string& url) {
  options.server_words = {"--no-bake"};
  if (!url.empty()) options.server_words.insert(options.server_words.end(), {"--workers", url});
  return options;
}

bool are_measured(uint16_t port, int workers) {
  for (int i = 0; i < workers; i++) {
    const std::string name = fmt::format("worker_samples_per_second{{worker=\"bench-{}\"}}", i);
    if (!(read_metric(port, name) > 0)) return false;
  }
  return true;
}

// Looks until the server knows its workers.
void know_workers(WsClient& client, uint16_t port, int workers) {
  const auto nothing = [](const WsMessage&) {};
  for (const double end = seconds_now() + trace_wait; !are_measured(port, workers);) {
    if (seconds_now() > end) throw std::runtime_error("not all workers trace");
    look_until(client, seconds_now() + 0.5, nothing);
  }
  look_until(client, seconds_now() + settling, nothing);
}

struct Shown {
  double seconds = 0;
  Image8 picture;
};

// Leaps to a viewpoint and stands there for so long.
std::vector<Shown> look_at_rest(const BenchOptions& options, const std::string& url, int count,
                                double seconds) {
  const std::vector<HeldWorker> workers =
      hold_workers(options, measured_exhibit, url, count, worker_share);
  const ServerProcess server(with_workers(options, count ? url : ""), measured_exhibit);
  WsClient client;
  join_visit(client, server.port, small_width, small_height);
  StorytellerOrder away;
  away.visible = false;
  client.send_text(write_message(away));
  know_workers(client, server.port, count);
  const Hold hold(server.id(), resting_share);
  look_until(client, seconds_now() + settling, [](const WsMessage&) {});
  Screen screen(small_width, small_height);
  std::vector<Shown> shown;
  client.send_text(write_message(ViewpointTo{1, measured_viewpoint}));
  const double began = seconds_now();
  look_until(client, began + seconds, [&](const WsMessage& message) {
    const auto packet = read_packet(message.bytes);
    if (!packet || packet->header.seq < 1 || !screen.receive(message.bytes)) return;
    shown.push_back({seconds_now() - began, screen.picture()});
  });
  client.close();
  if (shown.empty()) throw std::runtime_error("no picture of the viewpoint arrived");
  return shown;
}

struct Judged {
  double seconds = 0, flip = 0;
};

std::vector<Judged> judge_all(const std::vector<Shown>& shown, const Converged& wanted) {
  std::vector<Judged> judged;
  for (const Shown& one : shown) judged.push_back({one.seconds, judge(one.picture, wanted)});
  return judged;
}

double flip_at(const std::vector<Judged>& judged, double seconds) {
  double flip = judged.front().flip;
  for (const Judged& one : judged)
    if (one.seconds <= seconds) flip = one.flip;
  return flip;
}

double time_to(const std::vector<Judged>& judged, double flip) {
  for (const Judged& one : judged)
    if (one.flip <= flip) return one.seconds;
  return std::nan("");
}

enum class Line { none, good, far, stalled, stopped, killed };
constexpr const char* line_names[] = {"none",           "2",          "2, 200 ms away",
                                      "2, lines stall", "2, stopped", "2, killed"};

Stroll walk_with(const BenchOptions& options, const OwnNats& nats, Line line) {
  const int count = line == Line::none ? 0 : 2;
  std::optional<ShapedLine> between;
  std::string url = nats.url();
  if (line == Line::far || line == Line::stalled) {
    between.emplace(options, nats.port(), 1000, line == Line::far ? 400 : 0, size_t(1) << 24);
    url = fmt::format("nats://127.0.0.1:{}", between->port);
  }
  const std::vector<HeldWorker> workers =
      hold_workers(options, measured_exhibit, url, count, worker_share);
  const ServerProcess server(with_workers(options, count ? nats.url() : ""), measured_exhibit);
  {
    WsClient client;
    join_visit(client, server.port, small_width, small_height);
    know_workers(client, server.port, count);
    client.close();
  }
  const Hold hold(server.id(), walking_share);
  StrollPlan plan;
  plan.port = server.port;
  plan.width = small_width, plan.height = small_height;
  plan.warm_up = 4, plan.seconds = options.quick ? 8 : 20;
  return stroll_through(plan, [&] {
    if (line == Line::stalled) kill(between->id(), SIGSTOP);
    if (line != Line::stopped && line != Line::killed) return;
    for (const HeldWorker& worker : workers)
      kill(worker.program->id(), line == Line::stopped ? SIGSTOP : SIGKILL);
  });
}

}  // namespace

void measure_rest(BenchReport& report, const BenchOptions& options, const OwnNats& nats) {
  const double seconds = options.quick ? 30 : 60;
  const ShowTruth truth(options, measured_exhibit, options.visit_spp > 0 ? options.visit_spp : 32);
  const Exhibit& loaded = truth.exhibit();
  const Viewpoint& at = loaded.viewpoints[size_t(find_viewpoint(loaded, measured_viewpoint))].view;
  const Converged wanted = truth.converge(truth.view(at, small_width, small_height));
  constexpr int counts[] = {0, 1, 3};
  std::vector<double> until[3], ratios[3], pictures[3], flips[3][5];
  constexpr double moments[] = {3, 6, 12, 25, 50};
  for (int round = 0; round < (options.quick ? 1 : 3); round++) {
    double goal = 0, alone = 0;
    for (size_t i = 0; i < std::size(counts); i++) {
      const auto judged = judge_all(look_at_rest(options, nats.url(), counts[i], seconds), wanted);
      if (i == 0) goal = flip_at(judged, seconds / 2);
      const double time = time_to(judged, goal);
      if (i == 0) alone = time;
      pictures[i].push_back(double(judged.size()));
      until[i].push_back(time), ratios[i].push_back(time / alone);
      for (size_t k = 0; k < std::size(moments); k++)
        flips[i][k].push_back(flip_at(judged, moments[k]));
    }
  }
  for (size_t i = 0; i < std::size(counts); i++) {
    const nlohmann::json fields = {{"workers", counts[i]}, {"spp", truth.spp()}};
    for (size_t k = 0; k < std::size(moments) && moments[k] <= seconds; k++) {
      nlohmann::json where = fields;
      where["seconds"] = moments[k];
      report.add("workers.rest_flip", quantile(flips[i][k], 0.5), "FLIP", where);
    }
    report.add("workers.rest_pictures", quantile(pictures[i], 0.5), "", fields);
    report.add("workers.rest_until", quantile(until[i], 0.5), "s", fields);
    report.add("workers.rest_ratio", quantile(ratios[i], 0.5), "", fields);
  }
}

void measure_walks(BenchReport& report, const BenchOptions& options, const OwnNats& nats) {
  constexpr Line lines[] = {Line::none,    Line::good,    Line::far,
                            Line::stalled, Line::stopped, Line::killed};
  struct Figures {
    std::vector<double> p50, p95, p50_over, p95_over, fps;
  };
  Figures all[std::size(lines)];
  for (int round = 0; round < (options.quick ? 1 : 3); round++)
    for (size_t i = 0; i < std::size(lines); i++) {
      const Stroll seen = walk_with(options, nats, lines[i]);
      Figures& one = all[i];
      one.p50.push_back(quantile(seen.latencies, 0.5));
      one.p95.push_back(quantile(seen.latencies, 0.95));
      one.fps.push_back(seen.fps());
      one.p50_over.push_back(one.p50.back() / all[0].p50.back());
      one.p95_over.push_back(one.p95.back() / all[0].p95.back());
    }
  for (size_t i = 0; i < std::size(lines); i++) {
    const nlohmann::json fields = {{"line", line_names[i]}};
    report.add("workers.walk_p50", quantile(all[i].p50, 0.5), "ms", fields);
    report.add("workers.walk_p95", quantile(all[i].p95, 0.5), "ms", fields);
    report.add("workers.walk_p50_over", quantile(all[i].p50_over, 0.5), "", fields);
    report.add("workers.walk_p95_over", quantile(all[i].p95_over, 0.5), "", fields);
    report.add("workers.walk_fps", quantile(all[i].fps, 0.5), "1/s", fields);
  }
}

}  // namespace wellspring::test
