// SPDX-License-Identifier: Apache-2.0
#include "held_workers.h"

#include <chrono>
#include <fmt/core.h>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "base/clock.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

constexpr double nats_wait = 120;  // seconds

void write_word(const fs::path& file, const std::string& word) {
  std::ofstream out(file);
  out << word << std::flush;
  if (!out) throw std::runtime_error(file.string() + " cannot be written");
}

std::string find_url(const std::string& folder) {
  for (double end = seconds_now() + nats_wait; seconds_now() < end;) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      std::ifstream in(entry.path());
      const auto ports = nlohmann::json::parse(in, nullptr, false);
      if (ports.is_object() && ports.contains("nats")) return ports["nats"][0];
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  throw std::runtime_error("nats-server does not answer");
}

}  // namespace

Hold::Hold(pid_t process, double cores) {
  const fs::path root = "/sys/fs/cgroup";
  const bool first = fs::exists(root / "cpu/cpu.shares");
  folder_ = (first ? root / "cpu" : root) / fmt::format("wellspring-bench-{}", process);
  fs::create_directory(folder_);
  // All else on the machine gives way, so that the process has all of its share.
  const int quota = int(100000 * cores);
  if (first) {
    write_word(folder_ / "cpu.cfs_quota_us", std::to_string(quota));
    write_word(folder_ / "cpu.shares", "100000");
  } else {
    write_word(folder_ / "cpu.max", fmt::format("{} 100000", quota));
    write_word(folder_ / "cpu.weight", "10000");
  }
  write_word(folder_ / "cgroup.procs", std::to_string(process));
}

Hold::~Hold() {
  std::error_code ignored;
  for (int i = 0; i < 50 && !fs::remove(folder_, ignored); i++)  // until the process has ended
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

std::vector<HeldWorker> hold_workers(const BenchOptions& options, const std::string& exhibit,
                                     const std::string& url, int count, double cores) {
  std::vector<HeldWorker> workers;
  for (int i = 0; i < count; i++) {
    HeldWorker worker;
    worker.program = std::make_unique<Child>(ChildSettings{
        .words = {(fs::path(options.programs) / "wellspring_worker").string(), "--nats", url,
                  "--content", options.content, "--exhibit", exhibit, "--cache",
                  truths_folder(options), "--cores", "1", "--name", fmt::format("bench-{}", i)}});
    worker.hold = std::make_unique<Hold>(worker.program->id(), cores);
    workers.push_back(std::move(worker));
  }
  return workers;
}

OwnNats::OwnNats()
    : program_({.words = {"nats-server", "-a", "127.0.0.1", "-p", "-1", "--ports_file_dir",
                          folder_.path()}}),
      url_(find_url(folder_.path())) {}

uint16_t OwnNats::port() const { return uint16_t(std::stoi(url_.substr(url_.rfind(':') + 1))); }

}  // namespace wellspring::test
