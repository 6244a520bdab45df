// SPDX-License-Identifier: Apache-2.0
// A server process for benchmarks of the whole way, and what it says of itself over HTTP.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "base/child.h"
#include "base/layers.h"
#include "judge/ws_client.h"
#include "own_folder.h"
#include "report.h"

namespace wellspring::test {

// Runs a server of its own on a free port, as `./wellspring run` starts one, and ends it with this
// value. The server's cache is a folder of its own, empty at first and removed in the end, unless
// BenchOptions::server_words name another by --cache=FOLDER. Throws std::runtime_error if it cannot
// be started.
class ServerProcess {
 public:
  ServerProcess(const BenchOptions& options, const std::string& exhibit);
  pid_t id() const { return process_->id(); }
  double resident() const;      // memory in bytes
  double core_seconds() const;  // processor time so far
  uint16_t port = 0;
  double started = 0;  // seconds_now() when its process began

 private:
  std::optional<OwnFolder> cache_;
  std::optional<Child> process_;
};

// Opens a visit there, as a page does, of pictures of this size.
void join_visit(WsClient& client, uint16_t port, int width = 1280, int height = 720,
                const std::string& display = "server");

// The body of what it answers; empty where it does not. `path` begins with a slash.
std::string fetch(uint16_t port, const std::string& path);
// Returns a figure of the server's /metrics; NaN if it has none of that name.
double read_metric(uint16_t port, const std::string& name);

}  // namespace wellspring::test
