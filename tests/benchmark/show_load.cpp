// SPDX-License-Identifier: Apache-2.0
// show.load: the walk of show.walk while the server has few cores, idle or wanted by as many busy
// threads.
#include <atomic>
#include <filesystem>
#include <optional>
#include <pthread.h>
#include <sched.h>
#include <stdexcept>
#include <thread>

#include "show_visit.h"

namespace wellspring::test {
namespace {

using Cores = std::vector<int>;

Cores allowed_cores() {
  cpu_set_t set;
  sched_getaffinity(0, sizeof set, &set);
  Cores cores;
  for (int i = 0; i < CPU_SETSIZE; i++)
    if (CPU_ISSET(i, &set)) cores.push_back(i);
  return cores;
}

void stay_on(const Cores& cores) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (int core : cores) CPU_SET(core, &set);
  if (pthread_setaffinity_np(pthread_self(), sizeof set, &set) != 0)
    throw std::runtime_error("cores cannot be chosen");
}

// The server's process inherits the affinity of the thread that starts it.
struct ServerOnCores {
  std::optional<ServerProcess> process;
  ServerOnCores(const BenchOptions& options, const Cores& cores) {
    const Cores all = allowed_cores();
    stay_on(cores);
    process.emplace(options, "castle");
    stay_on(all);
  }
};

// A thread on each core that does nothing but want it.
struct OtherWork {
  std::vector<std::jthread> threads;
  explicit OtherWork(const Cores& cores) {
    for (int core : cores)
      threads.emplace_back([core](std::stop_token stop) {
        stay_on({core});
        for (std::atomic<unsigned> work = 0; !stop.stop_requested();) work++;
      });
  }
};

}  // namespace

void bench_show_load(BenchReport& report, const BenchOptions& options) {
  WalkJudge judge(options, load_walk(options));
  const Cores all = allowed_cores();
  struct Run {
    ShownWalk walk;
    nlohmann::json where;
  };
  std::vector<Run> runs;
  for (size_t cores : {1, 2, 4})
    for (bool busy : {false, true}) {
      if (options.quick && (cores == 4 || (cores == 1) != busy)) continue;
      if (cores > all.size()) {
        if (!busy)
          std::printf("show.load: left out with %zu cores: there are %zu\n", cores, all.size());
        continue;
      }
      const Cores some(all.begin(), all.begin() + long(cores));
      const ServerOnCores server(options, some);
      const OtherWork other(busy ? some : Cores{});
      runs.push_back({walk_along(*server.process, judge.poses()),
                      {{"scene", "castle"}, {"cores", cores}, {"busy", busy}}});
    }
  for (const Run& run : runs) judge.add(report, "show.load", run.walk, run.where);
}

}  // namespace wellspring::test
