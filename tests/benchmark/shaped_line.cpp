// SPDX-License-Identifier: Apache-2.0
#include "shaped_line.h"

#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

extern char** environ;

namespace wellspring::test {

ShapedLine::ShapedLine(const BenchOptions& options, uint16_t server, double mbit, double trip_ms,
                       size_t queue) {
  const std::string script =
      (std::filesystem::path(options.web) / "../tests/shaped_line.mjs").lexically_normal();
  std::vector<std::string> words = {"node",
                                    script,
                                    std::to_string(server),
                                    std::to_string(mbit),
                                    std::to_string(trip_ms),
                                    std::to_string(queue)};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  int in[2], out[2];
  if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0)
    throw std::runtime_error("pipe failed");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], 1);
  const int failed = posix_spawnp(&pid_, "node", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(in[0]), ::close(out[1]);
  orders_ = in[1];
  if (failed) throw std::runtime_error("node cannot be started");
  std::FILE* answer = fdopen(out[0], "r");
  int found = 0;
  const int read = std::fscanf(answer, "%d", &found);
  std::fclose(answer);
  if (read != 1) throw std::runtime_error(script + ": did not print its port");
  port = uint16_t(found);
}
ShapedLine::~ShapedLine() {
  ::close(orders_);  // it ends with its input
  waitpid(pid_, nullptr, 0);
}

void ShapedLine::set_rate(double mbit) {
  const std::string text = std::to_string(mbit);
  if (write(orders_, text.data(), text.size()) < 0) throw std::runtime_error("the line is gone");
}

}  // namespace wellspring::test
