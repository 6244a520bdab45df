// SPDX-License-Identifier: Apache-2.0
// What other threads may know of a running show: a copy, published after each tick.
#pragma once
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "avatar/mind/storyteller_io.h"
#include "show/state/baker.h"
#include "show/state/totals.h"
#include "wire/messages.h"

namespace wellspring {

struct VisitorReport {
  uint64_t id = 0;
  int width = 0, height = 0, budget = 0, quality = 0;
  float fps = 0, round_trip_ms = 0, display_ms = 0, trace_ms = 0, drawing_ms = 0, tonemap_ms = 0,
        encode_ms = 0,
        decode_ms = 0;  // the last: as the browser measures it
  float drawn_fps = 0, warp_ms = 0, moving_ms = 0, whole_ms = 0;
  float fresh = 0, empty = 0, converged = 0, mean_age = 0;
  uint64_t cache_bytes = 0, memory_bytes = 0, dropped = 0;
  bool kiosk = false;
  std::string name;  // as a kiosk's page calls itself; may be empty
};

struct ShowReport {
  bool ready = false;
  double time = 0;
  uint64_t ticks = 0, bad_samples = 0, drawing_bytes = 0;
  std::string denoiser_problem;  // why there is no network; empty: there is one
  float samples_per_second = 0;
  int kiosks = 0;
  Presence audience = Presence::absent;  // before the kiosks' cameras
  Mood mood = Mood::idle;                // of the storyteller
  ShowTotals totals;
  const char* display = "points";  // how visitors' pictures get their diffuse light
  float map_error = 1;             // of the illumination maps in use; 1: there are none
  size_t map_texels = 0;
  BakerStatus bake;
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
