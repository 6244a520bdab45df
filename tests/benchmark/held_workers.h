// SPDX-License-Identifier: Apache-2.0
// Workers, and a NATS server of their own, whose share of the processor is bounded; and what is
// measured with them besides samples a second: pictures at rest, and pictures of who walks.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/child.h"
#include "own_folder.h"
#include "report.h"

namespace wellspring::test {

// Holds a process to a share of a core by a control group of its own, of either version. Throws
// std::runtime_error where no such group can be made: root may.
class Hold {
 public:
  Hold(pid_t process, double cores);
  ~Hold();
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

 private:
  std::filesystem::path folder_;
};

struct HeldWorker {
  std::unique_ptr<Hold> hold;  // ends after the process
  std::unique_ptr<Child> program;
};
// Starts workers bench-0, bench-1 and so on, of one core each of which they have that share.
std::vector<HeldWorker> hold_workers(const BenchOptions& options, const std::string& exhibit,
                                     const std::string& url, int count, double cores);

// A NATS server on a port that it chooses itself.
class OwnNats {
 public:
  OwnNats();  // waits until it answers
  const std::string& url() const { return url_; }
  uint16_t port() const;

 private:
  OwnFolder folder_;
  Child program_;
  std::string url_;
};

// How soon a picture at rest is good, without workers and with some.
void measure_rest(BenchReport& report, const BenchOptions& options, const OwnNats& nats);
// How soon a visitor who walks sees it, without workers, with good ones, and with such behind lines
// that are long, stall, or lead to who is stopped or killed.
void measure_walks(BenchReport& report, const BenchOptions& options, const OwnNats& nats);

}  // namespace wellspring::test
