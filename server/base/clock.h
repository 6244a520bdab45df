// SPDX-License-Identifier: Apache-2.0
// Reads clocks: the time of day, the time since the start, and processor time. Ticks take the time
// as an argument, so that tests can set it.
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

// Returns the processor seconds that the calling thread has used so far.
inline double thread_seconds_now() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

// Returns the core-seconds that all threads of this process have used so far. The difference over a
// loop over cores is its cost: each of its threads has a clock of its own, and oneTBB decides which
// take part. Other work of the process meanwhile is counted, too; other programs are not, so that
// on a busy machine the cost stays the same.
inline double process_seconds_now() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

// Bounds how much a peer may say: `rate` a second on average, in bursts of up to `burst`.

struct RateBound {
  double rate = 1, burst = 1;
  double spent = 0;      // amount, part of the burst
  double last_time = 0;  // seconds, any clock that does not run backwards

  // Takes an amount. False: it is too much, and is not counted.
  bool take(double amount, double now) {
    spent = std::max(0.0, spent - rate * std::max(0.0, now - last_time));
    last_time = now;
    if (spent + amount > burst) return false;
    spent += amount;
    return true;
  }
  // Gives back an amount that was taken; a negative amount is taken in any case, whatever is left.
  void give_back(double amount) { spent = std::max(0.0, spent - amount); }
  // Returns the seconds after the last take() until `amount` is not too much.
  double wait_for(double amount) const { return std::max(0.0, (spent + amount - burst) / rate); }
};

// Shows how far long work of the command line has come, on one line of a terminal: each line takes
// the place of the last. If stderr is no terminal, nothing is written, unless the caller wants
// lines there.

// Returns "render [##########....................] 33 %, 0:40 left". `done`: 0 to 1; `seconds`:
// time that this took. The time left is not guessed in the first seconds. `more` follows a comma.
std::string progress_line(std::string_view what, double done, double seconds,
                          std::string_view more = {});

class Progress {
 public:
  // `seconds_elsewhere`: time from one line to the next if stderr is no terminal; 0: none are
  // written.
  explicit Progress(std::string what, double seconds_elsewhere = 0);
  ~Progress() { clear(); }
  // Writes a line, at most ten times a second. Any thread, as often as it likes.
  void tell(double done, std::string_view more = {});
  void clear();  // removes the line, before anything else is written

 private:
  const std::string what_;
  const bool terminal_;
  const double pause_, began_;
  std::mutex mutex_;  // guards the next fields
  double told_ = -1e9;
  bool stands_ = false;  // a line stands on the terminal
};

}  // namespace wellspring
