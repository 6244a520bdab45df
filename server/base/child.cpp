// SPDX-License-Identifier: Apache-2.0
#include "base/child.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "base/clock.h"

extern char** environ;

namespace wellspring {

namespace {

// Returns the error's number; 0: it runs.
int spawn(const ChildSettings& settings, const std::vector<std::pair<int, int>>& files, pid_t& id) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  int most = STDERR_FILENO;
  for (const auto& [ours, there] : files) {
    posix_spawn_file_actions_adddup2(&actions, ours, there);
    most = std::max(most, there);
  }
  posix_spawn_file_actions_addclosefrom_np(&actions, most + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  constexpr int apart = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP;
  posix_spawnattr_setflags(&attributes, settings.apart ? apart : 0);
  std::vector<char*> words;
  for (const std::string& word : settings.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const char* program = settings.program.empty() ? words[0] : settings.program.c_str();
  const int error = posix_spawnp(&id, program, &actions, &attributes, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error;
}

}  // namespace

Child::Child(const ChildSettings& settings) : apart_(settings.apart), patience_(settings.patience) {
  int in[2] = {-1, -1}, out[2] = {-1, -1}, error = 0;
  std::vector<std::pair<int, int>> files;  // pipes first: other files may take their numbers
  if (settings.reads >= 0) error = pipe2(in, O_CLOEXEC), files.emplace_back(in[0], settings.reads);
  if (settings.writes >= 0 && error == 0)
    error = pipe2(out, O_CLOEXEC), files.emplace_back(out[1], settings.writes);
  files.insert(files.end(), settings.files.begin(), settings.files.end());
  error = error == 0 ? spawn(settings, files, id_) : errno;
  to_ = in[1], from_ = out[0];
  for (int end : {in[0], out[1]}) close(end);
  if (error == 0) return;
  for (int end : {to_, from_}) close(end);
  throw std::runtime_error(settings.words[0] + " cannot be started: " + std::strerror(error));
}

Child::~Child() {
  for (int end : {to_, from_}) close(end);
  if (id_ == 0) return;
  const pid_t whom = apart_ ? -id_ : id_;
  if (patience_ > 0) kill(whom, SIGTERM);
  if (patience_ > 0 && wait(patience_)) return;
  kill(whom, SIGKILL);
  wait();
}

std::optional<int> Child::wait(double seconds) {
  const double until = seconds_now() + seconds;
  while (id_ != 0) {
    int status = 0;
    const pid_t ended = waitpid(id_, &status, std::isinf(seconds) ? 0 : WNOHANG);
    if (ended == id_ || (ended < 0 && errno != EINTR)) {
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
      id_ = 0;
    } else if (seconds_now() > until) {
      return {};
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  return status_;
}

}  // namespace wellspring
