// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/eye_process.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "wire/json.h"

extern char** environ;

namespace wellspring::kiosk {
namespace {

constexpr size_t longest_line = 64 * 1024;
constexpr double patience = 2;  // seconds for it to end

[[noreturn]] void fail(const char* what, int error) {
  throw std::runtime_error("the eye's process: " + std::string(what) + ": " + std::strerror(error));
}

}  // namespace

bool write_line(int fd, const std::string& line) {
  std::string text = line + '\n';
  for (size_t done = 0; done < text.size();) {
    ssize_t wrote = write(fd, text.data() + done, text.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += size_t(wrote);
  }
  return true;
}

std::optional<EyeOrder> Orders::take() {
  pollfd readable{STDIN_FILENO, POLLIN, 0};
  char piece[4096];
  while (text_.size() <= longest_line && poll(&readable, 1, 0) > 0) {
    const ssize_t count = read(STDIN_FILENO, piece, sizeof piece);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text_.append(piece, size_t(count));
  }
  std::optional<EyeOrder> newest;
  for (size_t end; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1)) {
    auto order = read_eye_order(std::string_view(text_).substr(0, end));
    if (EyeOrder* found = std::get_if<EyeOrder>(&order)) newest = std::move(*found);
  }
  if (text_.size() > longest_line) text_.clear();
  return newest;
}

EyeProcess::EyeProcess(std::vector<std::string> arguments, size_t eye) {
  int ends[2], orders[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail("no pipe", errno);
  lines_ = ends[0];
  if (pipe2(orders, O_CLOEXEC) != 0) fail("no pipe", errno);
  orders_ = orders[1];
  fcntl(orders_, F_SETFL, O_NONBLOCK);
  arguments.push_back(observe_to);
  arguments.push_back(std::to_string(observe_fd));
  arguments.push_back(of_camera);
  arguments.push_back(std::to_string(eye));
  std::vector<char*> words;
  for (std::string& word : arguments) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, orders[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], observe_fd);
  posix_spawn_file_actions_addclosefrom_np(&actions, observe_fd + 1);  // the way to the server
  int error = posix_spawn(&process_, "/proc/self/exe", &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  close(orders[0]);
  if (error == 0) return;
  close(lines_);
  close(orders_);
  fail("cannot be started", error);
}

EyeProcess::~EyeProcess() {
  close(lines_);
  close(orders_);
  if (process_ < 0) return;
  kill(process_, SIGTERM);
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  while (waitpid(process_, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > until) kill(process_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void EyeProcess::tell(const std::string& line) {
  const std::string text = line + '\n';
  // Whole or not at all: it is shorter than PIPE_BUF.
  [[maybe_unused]] const ssize_t wrote = write(orders_, text.data(), text.size());
}

EyeProcess::Heard EyeProcess::take(std::string& line, double seconds) {
  bool waited = false;
  for (;;) {
    if (size_t end = text_.find('\n'); end != std::string::npos) {
      line = text_.substr(0, end);
      text_.erase(0, end + 1);
      if (!std::exchange(too_long_, false)) return Heard::line;
      continue;
    }
    if (text_.size() > longest_line) text_.clear(), too_long_ = true;
    pollfd readable{lines_, POLLIN, 0};
    const int wait = std::exchange(waited, true) ? 0 : int(1000 * seconds);
    if (poll(&readable, 1, wait) <= 0) return Heard::nothing;
    char piece[4096];
    ssize_t count = read(lines_, piece, sizeof piece);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return Heard::ended;
    text_.append(piece, size_t(count));
  }
}

int EyeProcess::status() {
  if (process_ < 0) return status_;
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  return status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace wellspring::kiosk
