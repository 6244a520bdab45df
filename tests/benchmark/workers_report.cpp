// SPDX-License-Identifier: Apache-2.0
// Measures how samples a second grow with the number of workers, each held to a quarter of a core.
#include <chrono>
#include <stdexcept>
#include <thread>

#include "about/version.h"
#include "base/clock.h"
#include "held_workers.h"
#include "light/technique/technique.h"
#include "picture/still/reconstruct_still.h"
#include "report.h"
#include "reports.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/state/make_show.h"
#include "show/state/visitor_picture.h"
#include "show/workers/world_state.h"
#include "workers/crew.h"
#include "workers/program_number.h"

namespace wellspring::test {
namespace {

constexpr int counts[] = {1, 2, 4, 6};
constexpr double share = 0.25;                    // share of a core that each worker has
constexpr double longest_wait = 120, settle = 4;  // seconds

// Gives a crew as much to trace as it takes.
class Feeder {
 public:
  Feeder(const Show& show, CrewSettings settings)
      : show_(show),
        view_(
            make_view(show.stage.exhibit.scene, show.stage.exhibit.viewpoints[0].view, 1280, 720)),
        crew_(std::move(settings), show.stage.exhibit.id, number_scene(show.stage),
              sample_bounds(*show.stage.world)) {
    errand_.rests = true;
    errand_.state = write_world_state(show.stage, show.cast, {});
    errand_.light = number_light(known_maps(show.stage).get());
  }
  void step() {
    crew_.advance();
    for (CrewSamples& some : crew_.take())
      for (Answer& answer : some.answers) broker_.answer(std::move(answer));
    broker_.collect();
    if (const int room = crew_.room(true); room > 0) {
      std::vector<Request> requests;
      const int count = std::min(room, away_requests.most_waiting);
      plan_still(view_, asked_, count, 1, requests);
      asked_ += uint64_t(count);
      broker_.ask(view_, {show_.stage.technique, show_.settings.transport}, requests);
      crew_.send(broker_, errand_, count, {});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  void run(double seconds) {
    for (const double end = seconds_now() + seconds; seconds_now() < end;) step();
  }
  CrewReport report() const { return crew_.report(); }

 private:
  const Show& show_;
  View view_;
  Broker broker_{away_requests};
  Errand errand_;
  uint64_t asked_ = 0;
  Crew crew_;
};

int measured_workers(const CrewReport& report) {
  int count = 0;
  for (const WorkerReport& worker : report.workers) count += worker.samples_per_second > 0;
  return count;
}

double measure(int count, const Show& show, const std::string& url, const BenchOptions& options) {
  const std::vector<HeldWorker> workers =
      hold_workers(options, show.stage.exhibit.id, url, count, share);
  CrewSettings settings;
  settings.channel.url = url;
  settings.channel.name = "wellspring bench";
  settings.version = program_number(version_number());
  Feeder feeder(show, std::move(settings));
  for (const double end = seconds_now() + longest_wait; seconds_now() < end;) {
    feeder.step();
    if (measured_workers(feeder.report()) == count) break;
  }
  if (measured_workers(feeder.report()) != count) throw std::runtime_error("not all workers trace");
  feeder.run(settle);
  const uint64_t before = feeder.report().totals.samples;
  const double began = seconds_now();
  feeder.run(options.quick ? 6 : 20);
  return double(feeder.report().totals.samples - before) / (seconds_now() - began);
}

}  // namespace

void bench_workers(BenchReport& report, const BenchOptions& options) {
  ShowSettings settings;
  settings.bakes = false;
  const auto show = make_show(load_exhibit(options.content + "/first-room"), settings);
  const OwnNats nats;
  double one = 0;
  for (int count : counts) {
    const double rate = measure(count, *show, nats.url(), options);
    if (count == 1) one = rate;
    const nlohmann::json fields = {{"workers", count}, {"cores_each", share}};
    report.add("workers.samples", rate, "1/s", fields);
    report.add("workers.efficiency", rate / (one * count), "", fields);
  }
  measure_rest(report, options, nats);
  measure_walks(report, options, nats);
}

ReportPage workers_page() {
  return {
      "workers",
      "What are workers good for, and can they do harm? Each is held to a quarter of a core by a "
      "control group, on the machine of the server, over NATS.",
      {"Efficiency: samples a second over those of one worker, over their number; the renderer of "
       "Wald et al. (2002, table 1) had 1 with 8 clients, 0.83 with 16.",
       "At rest: a server of a quarter of a core; FLIP against the converged picture so long after "
       "a visitor has leapt to a viewpoint and stands, and the time until it is as low as without "
       "workers at half the time that is measured.",
       "Walking: a server of half a core. What is wrong with both workers' lines goes wrong when "
       "the walk begins. Over: the time over that without workers in the same round."},
      {{.caption = "Samples, and the time until a picture at rest is good",
        .rows = {{"workers", "workers"}},
        .columns = {{"samples", "samples a second", 1, "1/s"},
                    {"efficiency", "efficiency"},
                    {"rest_until", "at rest"},
                    {"rest_ratio", "over"},
                    {"rest_pictures", "pictures"}},
        .most_rows = 6},
       {.caption = "At rest: FLIP after seconds",
        .rows = {{"workers", "workers"}},
        .columns = {{"rest_flip", "FLIP"}},
        .across = "seconds",
        .most_rows = 3},
       {.caption = "Walking: input to picture",
        .rows = {{"line", "workers"}},
        .columns = {{"walk_p50", "p50"},
                    {"walk_p95", "p95"},
                    {"walk_p50_over", "p50 over"},
                    {"walk_p95_over", "p95 over"},
                    {"walk_fps", "pictures a second", 1, "1/s"}},
        .most_rows = 6}}};
}

}  // namespace wellspring::test
