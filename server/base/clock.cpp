// SPDX-License-Identifier: Apache-2.0
#include "base/clock.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/core.h>
#include <unistd.h>

namespace wellspring {

namespace {

constexpr int bar_width = 30;
constexpr double no_guess = 2;  // seconds in which the time left is not guessed
constexpr double least_pause = 0.1;

}  // namespace

std::string progress_line(std::string_view what, double done, double seconds,
                          std::string_view more) {
  done = std::clamp(done, 0.0, 1.0);
  const auto full = size_t(done * bar_width + 1e-9);
  std::string line = fmt::format("{} [{}{}] {} %", what, std::string(full, '#'),
                                 std::string(bar_width - full, '.'), int(100 * done + 1e-9));
  if (done > 0 && seconds >= no_guess) {
    const double left = std::ceil(seconds * (1 - done) / done - 1e-6);
    if (left < 100 * 3600) {
      const long all = long(left), hours = all / 3600, minutes = all / 60 % 60;
      line += hours > 0 ? fmt::format(", {}:{:02}:{:02} left", hours, minutes, all % 60)
                        : fmt::format(", {}:{:02} left", minutes, all % 60);
    }
  }
  if (!more.empty()) line += fmt::format(", {}", more);
  return line;
}

Progress::Progress(std::string what, double seconds_elsewhere)
    : what_(std::move(what)),
      terminal_(isatty(STDERR_FILENO)),
      pause_(terminal_ ? least_pause : seconds_elsewhere),
      began_(seconds_now()) {}

void Progress::tell(double done, std::string_view more) {
  if (pause_ <= 0) return;
  const double now = seconds_now();
  std::lock_guard lock(mutex_);
  if (now - told_ < pause_) return;
  told_ = now;
  const std::string line = progress_line(what_, done, now - began_, more);
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(stderr);
  stands_ = terminal_;
}

void Progress::clear() {
  std::lock_guard lock(mutex_);
  if (!stands_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  stands_ = false;
  told_ = -1e9;
}

}  // namespace wellspring
