// SPDX-License-Identifier: Apache-2.0
// Measures how samples a second grow with the number of workers, each held to a quarter of a core.
#include <chrono>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "about/version.h"
#include "base/child.h"
#include "base/clock.h"
#include "light/technique/technique.h"
#include "own_folder.h"
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

namespace fs = std::filesystem;

constexpr int counts[] = {1, 2, 4, 6};
constexpr double share = 0.25;                    // share of a core that each worker has
constexpr double longest_wait = 120, settle = 4;  // seconds

void write_word(const fs::path& file, const std::string& word) {
  std::ofstream out(file);
  out << word << std::flush;
  if (!out) throw std::runtime_error(file.string() + " cannot be written");
}

// Holds a process to a share of a core by a control group of its own, of either version.
class Hold {
 public:
  Hold(pid_t process, double cores) {
    const fs::path root = "/sys/fs/cgroup";
    const bool first = fs::exists(root / "cpu/cpu.shares");
    folder_ = (first ? root / "cpu" : root) / fmt::format("wellspring-bench-{}", process);
    fs::create_directory(folder_);
    const int quota = int(100000 * cores);
    if (first) write_word(folder_ / "cpu.cfs_quota_us", std::to_string(quota));
    else write_word(folder_ / "cpu.max", fmt::format("{} 100000", quota));
    write_word(folder_ / "cgroup.procs", std::to_string(process));
  }
  ~Hold() {
    std::error_code ignored;
    for (int i = 0; i < 50 && !fs::remove(folder_, ignored); i++)  // until the process has ended
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

 private:
  fs::path folder_;
};

struct HeldWorker {
  std::unique_ptr<Hold> hold;  // ends after the process
  std::unique_ptr<Child> program;
};

// A NATS server on a port that it chooses itself.
struct OwnNats {
  OwnFolder folder;
  Child program{
      {.words = {"nats-server", "-a", "127.0.0.1", "-p", "-1", "--ports_file_dir", folder.path()}}};
  std::string url() const {
    for (double end = seconds_now() + longest_wait; seconds_now() < end;) {
      for (const auto& entry : fs::directory_iterator(folder.path())) {
        std::ifstream in(entry.path());
        const auto ports = nlohmann::json::parse(in, nullptr, false);
        if (ports.is_object() && ports.contains("nats")) return ports["nats"][0];
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    throw std::runtime_error("nats-server does not answer");
  }
};

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
  std::vector<HeldWorker> workers;
  for (int i = 0; i < count; i++) {
    HeldWorker worker;
    worker.program = std::make_unique<Child>(ChildSettings{
        .words = {(fs::path(options.programs) / "wellspring_worker").string(), "--nats", url,
                  "--content", options.content, "--exhibit", show.stage.exhibit.id, "--cache",
                  truths_folder(options), "--cores", "1", "--name", fmt::format("bench-{}", i)}});
    worker.hold = std::make_unique<Hold>(worker.program->id(), share);
    workers.push_back(std::move(worker));
  }
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
}

ReportPage workers_page() {
  return {"workers",
          "How do samples a second grow with the number of workers? Each is held to a quarter of a "
          "core by a control group, on the machine of the server, over NATS.",
          {"Efficiency: samples a second over those of one worker, over their number."},
          {{.caption = "",
            .rows = {{"workers", "workers"}},
            .columns = {{"samples", "samples a second", 1, "1/s"}, {"efficiency", "efficiency"}}}}};
}

}  // namespace wellspring::test
