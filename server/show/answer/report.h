// SPDX-License-Identifier: Apache-2.0
// What other threads may know of a running show: a copy, published after each tick.
#pragma once
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace wellspring {

// Counters since the start, unless said otherwise.
struct ShowTotals {
  uint64_t drawn = 0, warped = 0, unwarpable = 0;  // pictures; warps given up
  uint64_t posed = 0;         // what moves in pictures at rest, drawn by itself
  uint64_t reconstructed = 0;  // pictures at rest, by the network
  float reconstruction_ms = 0;  // of the last of these
  uint64_t surroundings = 0;  // drawn of quick turns
  uint64_t given_up = 0;      // pictures that nobody needed any more before they were drawn
  uint64_t pictures = 0, picture_bytes = 0, samples = 0, messages = 0, refused_messages = 0;
  float tick_ms = 0, animate_ms = 0;  // of the last tick
  uint64_t utterances = 0, sounds = 0,
           sounds_given_up = 0;  // spoken; packets sent; too slow a reader
  uint64_t visits = 0, turned_away = 0, observations = 0, greetings = 0, farewells = 0, stories = 0;
  uint64_t lamps_switched = 0;
};

struct VisitorReport {
  uint64_t id = 0;
  int width = 0, height = 0, budget = 0, quality = 0;
  float fps = 0, round_trip_ms = 0, display_ms = 0, trace_ms = 0, drawing_ms = 0,
        tonemap_ms = 0, encode_ms = 0;
  float drawn_fps = 0, warp_ms = 0, moving_ms = 0, whole_ms = 0;
  float fresh = 0, empty = 0, converged = 0, mean_age = 0;
  uint64_t cache_bytes = 0, memory_bytes = 0, dropped = 0;
  bool kiosk = false;
};

struct ShowReport {
  bool ready = false;
  double time = 0;
  uint64_t ticks = 0, bad_samples = 0, drawing_bytes = 0;
  std::string denoiser_problem;  // why there is no network; empty: there is one
  float samples_per_second = 0;
  int kiosks = 0;
  std::string audience = "absent", mood = "idle";
  ShowTotals totals;
  bool voice_running = false;
  uint64_t voice_restarts = 0, voice_lines = 0, voice_waiting = 0, voice_failed = 0;
  std::vector<VisitorReport> visitors;
};

// One writer, many readers; the lock is held for a copy.
class ReportBoard {
 public:
  void publish(ShowReport report) {
    std::lock_guard lock(mutex_);
    report_ = std::move(report);
  }
  ShowReport read() const {
    std::lock_guard lock(mutex_);
    return report_;
  }

 private:
  mutable std::mutex mutex_;
  ShowReport report_;
};

struct Show;
ShowReport make_report(const Show& show);

}  // namespace wellspring
