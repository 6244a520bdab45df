// SPDX-License-Identifier: Apache-2.0
// What other threads may know of a running show: a copy, published after each tick.
#pragma once
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "avatar/mind/storyteller_io.h"
#include "show/kiosk/kiosk.h"
#include "show/house/house.h"
#include "show/state/totals.h"
#include "show/visit/flow.h"
#include "wire/messages.h"
#include "workers/report.h"

namespace wellspring::show {

struct VisitorReport {
  uint64_t id = 0;
  int width = 0, height = 0, budget = 0, quality = 0;
  float fps = 0, round_trip_ms = 0, display_ms = 0, trace_ms = 0, drawing_ms = 0, lens_ms = 0,
        tonemap_ms = 0, encode_ms = 0,
        decode_ms = 0;               // the last: as the browser measures it
  int eighths = 8;                   // part of the width and height asked for
  Limit limit = Limit::none;         // why pictures are fewer, or less fine, than asked for
  float line_ms = 0, line_rate = 0;  // there and back; bytes a second; 0: not known
  float drawn_fps = 0, warp_ms = 0, moving_ms = 0, whole_ms = 0;
  float fresh = 0, empty = 0, converged = 0, mean_age = 0;
  uint64_t cache_bytes = 0, memory_bytes = 0;
  uint64_t dropped = 0, sounds_dropped = 0, texts_dropped = 0;
  bool walks = false;     // or is taken along, at the moment
  float interval_ms = 0;  // from one picture drawn to the next, while it does
  bool kiosk = false;
  std::string name;  // as a kiosk's page calls itself; may be empty
};

struct KioskReport {
  std::string name;  // may be empty
  Stage stage = Stage::sleep;
  size_t people = 0;
  bool storyteller = false;      // is there
  int screens = 0, cameras = 0;  // pages open, cameras connected
};

struct CameraReport {
  std::string kiosk;    // its kiosk's name; may be empty
  uint32_t number = 0;  // Eye::number
  std::string name;     // as the kiosk's program calls it; may be empty
  // One of camera_states; "silent": it has said nothing for long; "disconnected"; "calibrating".
  std::string state;
  double since = 0;  // seconds that it has been so
  EyeParts parts{};
};

// Counts what the server's sockets did since the start.
struct DoorCounts {
  uint64_t floods_closed = 0;  // connections, for sending more than any page does
  uint64_t accept_errors = 0;  // times that a connection could not be taken
};

struct ShowReport {
  bool ready = false;
  double time = 0;
  int cores = 0;
  uint64_t ticks = 0, bad_samples = 0, drawing_bytes = 0;
  std::string denoiser_problem;  // why there is no network; empty: there is one
  float samples_per_second = 0;
  std::vector<KioskReport> kiosks;
  bool open = true, quiet = false;  // the house is
  int connected_cameras = 0;
  std::vector<CameraReport> cameras;     // those, and some that were until a short time ago
  Presence audience = Presence::absent;  // before all of these
  Mood mood = Mood::idle;                // mood of the storyteller
  ShowTotals totals;
  const char* display = "points";  // how visitors' pictures get their diffuse light
  float map_error = 1;             // error of the illumination maps in use; 1: there are none
  size_t map_texels = 0;
  std::string light_problem;  // problem with the package's own light; empty: none
  BakerStatus bake;
  CrewReport workers;
  bool voice_running = false;
  uint64_t voice_restarts = 0, voice_lines = 0, voice_waiting = 0, voice_failed = 0;
  std::vector<VisitorReport> visitors;
  size_t all_visitors = 0;      // visitors of all exhibits of the process, who share its cores
  size_t exhibit_problems = 0;  // Show::problems
  // The following values count all exhibits of the process; the report of the first holds them.
  size_t waiting = 0;        // visitors for whom there is no seat yet
  uint64_t turned_away = 0;  // since so many waited already
  std::string sums_problem;  // why the ledger cannot be written; whoever has one sets it
  DoorCounts doors;          // likewise
  std::vector<std::string> damaged_files;  // files of the cache (base/write_file.h); likewise
  std::vector<std::string> full_disks;     // places that cannot be written; likewise
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

}  // namespace wellspring::show
