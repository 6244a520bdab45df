// SPDX-License-Identifier: Apache-2.0
// Which day it is, where the system's clock may be wild: a machine that begins in 1970, a battery
// that is empty, a typing error.
//
// The clock is believed as long as it goes on as it was, give or take a day. Where it jumps
// farther, either way, days go on by what it was before, for an hour; one that has stayed by then
// is believed, as a clock that was corrected is. One that shows a time before 2020 was never set:
// it is never believed, and days that are counted by it are none (ledger/ledger.h).
#pragma once
#include <ctime>
#include <optional>

namespace wellspring::museum {

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

}  // namespace wellspring::museum
