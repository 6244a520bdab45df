// SPDX-License-Identifier: Apache-2.0
// A line of so many bits a second and of so long a way to a server: tests/shaped_line.mjs, a
// program of Node.
#pragma once
#include <cstdint>

#include "base/child.h"
#include "report.h"

namespace wellspring::test {

class ShapedLine {
 public:
  // queue: bytes that are on their way at most, in each direction. Throws std::runtime_error if it
  // cannot be started.
  ShapedLine(const BenchOptions& options, uint16_t server, double mbit, double trip_ms,
             size_t queue = 64 * 1024);
  void set_rate(double mbit);
  pid_t id() const { return node_.id(); }  // the program's process
  uint16_t port = 0;                       // the near end's

 private:
  Child node_;
};

}  // namespace wellspring::test
