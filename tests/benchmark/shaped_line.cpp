// SPDX-License-Identifier: Apache-2.0
#include "shaped_line.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace wellspring::test {

namespace {
std::string script_of(const BenchOptions& options) {
  return (std::filesystem::path(options.web) / "../tests/shaped_line.mjs").lexically_normal();
}
}  // namespace

ShapedLine::ShapedLine(const BenchOptions& options, uint16_t server, double mbit, double trip_ms,
                       size_t queue)
    : node_({.words = {"node", script_of(options), std::to_string(server), std::to_string(mbit),
                       std::to_string(trip_ms), std::to_string(queue)},
             .reads = 0,
             .writes = 1,
             .patience = 2}) {
  std::FILE* answer = fdopen(dup(node_.from()), "r");
  int found = 0;
  const int read = std::fscanf(answer, "%d", &found);
  std::fclose(answer);
  if (read != 1) throw std::runtime_error(script_of(options) + ": did not print its port");
  port = uint16_t(found);
}

void ShapedLine::set_rate(double mbit) {
  const std::string text = std::to_string(mbit);
  if (write(node_.to(), text.data(), text.size()) < 0) throw std::runtime_error("the line is gone");
}

}  // namespace wellspring::test
