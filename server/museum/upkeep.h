// SPDX-License-Identifier: Apache-2.0
// Tells whether a show goes on: its ticks, and the drawing beside them.
#pragma once
#include <atomic>
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

namespace wellspring::museum {

// Finds which day it is even if the system's clock is wrong: a machine that begins in 1970, a
// battery that is empty, a typing error.
//
// The clock is believed as long as it goes on as it was, give or take a day. If it jumps farther,
// either way, days go on by the time before the jump for an hour; if the new time has stayed by
// then, it is believed, as of a clock that was corrected. A clock that shows a time before 2020 was
// never set: it is never believed, and no days are counted by it (ledger/ledger.h).

class Calendar {
 public:
  static constexpr std::time_t first_time = 1577836800;   // 2020-01-01
  static constexpr double leap = 86400, patience = 3600;  // seconds
  // Returns the time that is believed when the clock shows `wall`, at `steady` seconds of a clock
  // that does not run backwards. Until a time is believed, it is the one that the clock shows.
  std::time_t see(std::time_t wall, double steady);
  bool doubts() const { return doubted_.has_value(); }

 private:
  struct Seen {
    double wall = 0, steady = 0;
  };
  static double apart(const Seen& seen, std::time_t wall, double steady);
  std::optional<Seen> believed_, doubted_;  // `doubted_`: when the new time was first seen
};

// Watches the disks that a museum writes to.

class Disks {
 public:
  static constexpr uint64_t least_bytes = 4 << 20;  // a disk with fewer free bytes is full
  Disks() = default;
  // Takes the files or folders that are written to, there or not yet; empty ones are left out.
  Disks(std::string cache, std::string sums) : places_{std::move(cache), std::move(sums)} {}
  std::vector<std::string> full() const;  // returns the places whose disks are full

 private:
  std::vector<std::string> places_;
};

class Heartbeat {
 public:
  static constexpr double longest_drawing = 60;  // seconds; a drawing that takes longer hangs

  // Notes a tick; called after every tick by the show's thread, at `now` (seconds). `drawing`: the
  // number of the drawing that is under way; 0: there is none.
  void tick(double now, uint64_t drawing) {
    if (!drawing || drawing != drawing_) began_ = now;
    drawing_ = drawing;
    if (now - began_ < longest_drawing) beats_ = true;
  }
  // Returns whether the show has gone on since forget(). Any other thread.
  bool beats() const { return beats_; }
  void forget() { beats_ = false; }

 private:
  std::atomic<bool> beats_ = false;
  uint64_t drawing_ = 0;
  double began_ = 0;  // time at which that drawing began
};

}  // namespace wellspring::museum
