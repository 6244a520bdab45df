// SPDX-License-Identifier: Apache-2.0
// A server process for benchmarks of the whole way, and what it says of itself over HTTP.
#pragma once
#include <cstdint>
#include <string>
#include <sys/types.h>

#include "report.h"
#include "stream/ws_client.h"

namespace wellspring {

// A server of its own on a free port, ended with this value. Throws std::runtime_error if it cannot
// be started.
class ServerProcess {
 public:
  ServerProcess(const BenchOptions& options, const std::string& exhibit);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  double resident() const;  // memory in bytes
  uint16_t port = 0;

 private:
  pid_t pid_ = 0;
};

// Opens a visit there, of pictures of this size.
void join_visit(WsClient& client, uint16_t port, int width = 1280, int height = 720);

// The body of what it answers; empty where it does not. `path` begins with a slash.
std::string fetch(uint16_t port, const std::string& path);
// Of the server's /metrics; NaN where it has none of that name.
double read_metric(uint16_t port, const std::string& name);

}  // namespace wellspring
