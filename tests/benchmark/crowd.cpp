// SPDX-License-Identifier: Apache-2.0
#include "crowd.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sched.h>
#include <set>
#include <sstream>
#include <thread>
#include <unistd.h>

#include "base/clock.h"
#include "stream_server.h"
#include "stroll.h"

namespace wellspring::test {
namespace {

constexpr double look_interval = 0.4;   // seconds between looks at /metrics
constexpr double count_interval = 0.1;  // seconds between looks at other programs

// Returns the core-seconds that all programs of the machine have taken so far.
double machine_core_seconds() {
  std::ifstream file("/proc/stat");
  std::string word;
  double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, irq = 0, soft = 0, steal = 0;
  file >> word >> user >> nice >> system >> idle >> waiting >> irq >> soft >> steal;
  return (user + nice + system + irq + soft + steal) / double(sysconf(_SC_CLK_TCK));
}

// Returns how many sessions but our own have a thread that runs or wants to. Linux gives each the
// same part of the cores (sched(7), autogroups), however many threads it has.
int count_other_sessions() {
  namespace fs = std::filesystem;
  std::set<int> sessions;
  std::error_code gone;  // threads end meanwhile
  for (const auto& process : fs::directory_iterator("/proc", gone)) {
    if (std::atoi(process.path().filename().c_str()) <= 0) continue;
    for (const auto& thread : fs::directory_iterator(process.path() / "task", gone)) {
      std::ifstream file(thread.path() / "stat");
      std::string line, state;
      if (!std::getline(file, line)) continue;
      std::istringstream words(line.substr(line.rfind(')') + 1));
      int parent = 0, group = 0, session = 0;
      words >> state >> parent >> group >> session;
      if (state == "R") sessions.insert(session);
    }
  }
  sessions.erase(getsid(0));
  return int(sessions.size());
}

// Adds the figures of a text of /metrics to sums and counts by name, whoever they are of.
void add_metrics(const std::string& text, std::map<std::string, std::pair<double, int>>& sums) {
  const std::string head = "wellspring_";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(head)) continue;
    const size_t end = line.find_first_of(" {"), value = line.rfind(' ');
    auto& [sum, count] = sums[line.substr(head.size(), end - head.size())];
    sum += std::atof(&line[value + 1]), count++;
  }
}

std::map<std::string, double> means(const std::map<std::string, std::pair<double, int>>& sums) {
  std::map<std::string, double> values;
  for (const auto& [name, sum] : sums) values[name] = sum.first / sum.second;
  return values;
}

struct Spent {
  double time = 0, machine = 0, server = 0, own = 0;
};
Spent spent_by(const ServerProcess& server) {
  return {seconds_now(), machine_core_seconds(), server.core_seconds(), process_seconds_now()};
}

// Watches the server while the time that counts goes on.
void watch(const ServerProcess& server, const CrowdPlan& plan, CrowdSeen& seen) {
  using Seconds = std::chrono::duration<double>;
  std::this_thread::sleep_for(Seconds(plan.warm_up));
  std::map<std::string, std::vector<double>> all;
  std::map<std::string, std::pair<double, int>> first, last;
  const Spent before = spent_by(server);
  add_metrics(fetch(server.port, "/metrics"), first);
  double first_at = seconds_now(), last_at = first_at;
  double others = 0;
  int looks = 0;
  while (seconds_now() - before.time < plan.seconds - look_interval) {
    for (const double from = seconds_now(); seconds_now() - from < look_interval; looks++) {
      std::this_thread::sleep_for(Seconds(count_interval));
      others += count_other_sessions();
    }
    const std::string text = fetch(server.port, "/metrics");
    last.clear(), add_metrics(text, last);
    for (const auto& [name, value] : means(last)) all[name].push_back(value);
    last_at = seconds_now();
  }
  const Spent after = spent_by(server);
  const double time = after.time - before.time;
  seen.server_cores = (after.server - before.server) / time;
  seen.visitors_cores = (after.own - before.own) / time;
  seen.other_cores =
      (after.machine - before.machine) / time - seen.server_cores - seen.visitors_cores;
  seen.others = looks > 0 ? others / looks : 0;
  seen.resident = server.resident();
  for (const auto& [name, values] : all) seen.metrics[name] = quantile(values, 0.5);
  seen.begun = means(first), seen.ended = means(last);
  seen.watched = last_at - first_at;
  seen.keyframes = seen.growth("pictures_drawn_total") / plan.visitors;
}

// Keeps the calling thread, and the server that it starts, to the last core.
class LastCore {
 public:
  LastCore() {
    sched_getaffinity(0, sizeof all_, &all_);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int i = CPU_SETSIZE - 1; i >= 0 && CPU_COUNT(&one) == 0; i--)
      if (CPU_ISSET(i, &all_)) CPU_SET(i, &one);
    sched_setaffinity(0, sizeof one, &one);
  }
  ~LastCore() { sched_setaffinity(0, sizeof all_, &all_); }

 private:
  cpu_set_t all_;
};

}  // namespace

double CrowdSeen::growth(const std::string& name) const {
  const auto from = begun.find(name), to = ended.find(name);
  if (from == begun.end() || to == ended.end() || !(watched > 0)) return 0;
  return (to->second - from->second) / watched;
}

CrowdSeen measure_crowd(const BenchOptions& given, const CrowdPlan& plan) {
  BenchOptions options = given;
  // Everybody is let in, at however few pictures.
  for (const char* word : {"--least-fps", "0.01", "--max-visitors", "1000"})
    options.server_words.push_back(word);
  std::optional<LastCore> kept;
  if (plan.one_core) kept.emplace();
  const ServerProcess server(options, "castle");
  kept.reset();
  CrowdSeen seen;
  std::vector<Stroll> strolls;
  {
    std::jthread watcher([&] { watch(server, plan, seen); });
    strolls = stroll_together({.port = server.port,
                               .width = plan.width,
                               .height = plan.height,
                               .warm_up = plan.warm_up,
                               .seconds = plan.seconds,
                               .local = plan.local},
                              plan.visitors);
  }
  size_t count = 0;
  for (const Stroll& one : strolls) {
    seen.latencies.insert(seen.latencies.end(), one.latencies.begin(), one.latencies.end());
    seen.scales.insert(seen.scales.end(), one.scales.begin(), one.scales.end());
    for (double size : one.bytes) seen.bytes += size, count++;
  }
  seen.pictures = double(count) / plan.seconds / plan.visitors;
  if (count > 0) seen.bytes /= double(count);
  return seen;
}

}  // namespace wellspring::test
