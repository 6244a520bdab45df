// SPDX-License-Identifier: Apache-2.0
// Whether a show goes on: its ticks, and what is drawn beside them.
#pragma once
#include <atomic>
#include <cstdint>

namespace wellspring::museum {

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
