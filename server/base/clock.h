// SPDX-License-Identifier: Apache-2.0
// Clocks: of the day, since the start, and of processors. Ticks take the time as an argument, so
// that tests can set it.
#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <mutex>
#include <string>
#include <string_view>

#include "base/layers.h"

namespace wellspring {

// Returns monotonic seconds since the program started.
inline double seconds_now() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Returns microseconds since 1970, by which pictures and sound are dated on the wire.
inline uint64_t microseconds_now() {
  using namespace std::chrono;
  return uint64_t(duration_cast<microseconds>(system_clock::now().time_since_epoch()).count());
}

inline double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// Returns the seconds of a processor that the calling thread has had so far.
inline double thread_seconds_now() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

// Returns the core-seconds that all threads of this process have had so far. It tells what a loop
// over cores costs: each of its threads has a clock of its own, and oneTBB says which take part.
// What the process does beside is counted, too; what other programs do is not, so that on a busy
// machine the cost stays what it was.
inline double process_seconds_now() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

// A bound on how much a peer may say: `rate` a second on average, in bursts of up to `burst`.

struct RateBound {
  double rate = 1, burst = 1;
  double spent = 0;      // of the burst
  double last_time = 0;  // seconds, any clock that does not run backwards

  // False when this is too much; it is then not counted.
  bool take(double amount, double now) {
    spent = std::max(0.0, spent - rate * std::max(0.0, now - last_time));
    last_time = now;
    if (spent + amount > burst) return false;
    spent += amount;
    return true;
  }
  // Of what was taken; a negative amount is taken besides, whatever there is.
  void give_back(double amount) { spent = std::max(0.0, spent - amount); }
  // Seconds after the last take() until one of `amount` is not too much.
  double wait_for(double amount) const { return std::max(0.0, (spent + amount - burst) / rate); }
};

// How far long work of the command line has come, on one line of a terminal: each takes the place
// of the last. Where stderr is no terminal nothing is written, unless somebody wants lines there.

// "render [##########....................] 33 %, 0:40 left". `done`: 0 to 1; `seconds`: that this
// took. What is left is not guessed in the first seconds. `more` follows a comma.
std::string progress_line(std::string_view what, double done, double seconds,
                          std::string_view more = {});

class Progress {
 public:
  // `seconds_elsewhere`: from one line to the next where stderr is no terminal; 0: none are
  // written.
  explicit Progress(std::string what, double seconds_elsewhere = 0);
  ~Progress() { clear(); }
  // Any thread, as often as it likes: a line is written at most ten times a second.
  void tell(double done, std::string_view more = {});
  void clear();  // before anything else is written

 private:
  const std::string what_;
  const bool terminal_;
  const double pause_, began_;
  std::mutex mutex_;  // of what follows
  double told_ = -1e9;
  bool stands_ = false;  // a line, on the terminal
};

}  // namespace wellspring
