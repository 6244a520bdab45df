// SPDX-License-Identifier: Apache-2.0
// Whether a show goes on: its ticks, and what is drawn beside them.
#pragma once
#include <atomic>
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

namespace wellspring::museum {

// Which day it is, where the system's clock may be wild: a machine that begins in 1970, a battery
// that is empty, a typing error.
//
// The clock is believed as long as it goes on as it was, give or take a day. Where it jumps
// farther, either way, days go on by what it was before, for an hour; one that has stayed by then
// is believed, as a clock that was corrected is. One that shows a time before 2020 was never set:
// it is never believed, and days that are counted by it are none (ledger/ledger.h).

class Calendar {
 public:
  static constexpr std::time_t first_time = 1577836800;   // 2020-01-01
  static constexpr double leap = 86400, patience = 3600;  // seconds
  // The time that is believed when the clock shows `wall`, at `steady` seconds of a clock that does
  // not run backwards. Until one is believed: as the clock shows it.
  std::time_t see(std::time_t wall, double steady);
  bool doubts() const { return doubted_.has_value(); }

 private:
  struct Seen {
    double wall = 0, steady = 0;
  };
  static double apart(const Seen& seen, std::time_t wall, double steady);
  std::optional<Seen> believed_, doubted_;  // the latter since it was first seen so
};

// The disks that a museum writes to.

class Disks {
 public:
  static constexpr uint64_t least_bytes = 4 << 20;  // with fewer free ones it is full
  Disks() = default;
  // Both are what is written: files or folders, there or not yet; empty ones are left out.
  Disks(std::string cache, std::string sums) : places_{std::move(cache), std::move(sums)} {}
  std::vector<std::string> full() const;  // those of the places whose disks are

 private:
  std::vector<std::string> places_;
};

class Heartbeat {
 public:
  static constexpr double longest_drawing = 60;  // seconds; one that takes longer hangs

  // After every tick, by the show's thread, at `now` (seconds). `drawing`: the number of the
  // drawing that is under way; 0: there is none.
  void tick(double now, uint64_t drawing) {
    if (!drawing || drawing != drawing_) began_ = now;
    drawing_ = drawing;
    if (now - began_ < longest_drawing) beats_ = true;
  }
  // By any other thread: whether it has gone on since forget().
  bool beats() const { return beats_; }
  void forget() { beats_ = false; }

 private:
  std::atomic<bool> beats_ = false;
  uint64_t drawing_ = 0;
  double began_ = 0;  // that drawing
};

}  // namespace wellspring::museum
