// SPDX-License-Identifier: Apache-2.0
#include "kiosk/feed.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "base/clock.h"
#include "base/log.h"

namespace wellspring::kiosk {

namespace {
std::chrono::duration<double> seconds(double s) { return std::chrono::duration<double>(s); }
}  // namespace

struct Feed::Shared {
  std::mutex mutex;
  std::condition_variable changed;
  std::unique_ptr<Camera> camera;
  bool pace = false, stop = false, ended = false, finished = false;
  std::optional<GrayFrame> slot;

  // Sleeps; false when it is time to stop.
  bool rest(double length) {
    std::unique_lock lock(mutex);
    return !changed.wait_for(lock, seconds(length), [&] { return stop; });
  }

  void deliver(GrayFrame frame) {
    std::unique_lock lock(mutex);
    // Paced and live cameras overwrite what nobody took; an unpaced one waits for its reader.
    if (!camera->live() && !pace) changed.wait(lock, [&] { return stop || !slot; });
    if (stop) return;
    slot = std::move(frame);
    changed.notify_all();
  }

  void run() {
    const bool live = camera->live();
    bool lost = false;
    double begin = 0;
    bool first = true;
    for (;;) {
      {
        std::lock_guard lock(mutex);
        if (stop) break;
      }
      GrayFrame frame;
      Got got = camera->next(frame);
      if (got == Got::end) break;
      if (got == Got::lost) {
        if (!lost) log::warn("{} gives no picture; trying again every second", camera->name());
        lost = true;
        if (!rest(1)) break;
        continue;
      }
      if (lost) log::info("{} is back", camera->name());
      lost = false;
      if (!live && pace) {
        if (first) begin = seconds_now() - frame.time;
        double wait = begin + frame.time - seconds_now();
        if (wait > 0 && !rest(wait)) break;
      }
      first = false;
      deliver(std::move(frame));
    }
    std::lock_guard lock(mutex);
    ended = finished = true;
    changed.notify_all();
  }
};

Feed::Feed(std::unique_ptr<Camera> camera, bool pace) : shared_(std::make_shared<Shared>()) {
  shared_->camera = std::move(camera);
  shared_->pace = pace;
  std::thread([shared = shared_] { shared->run(); }).detach();
}

Feed::~Feed() {
  std::unique_lock lock(shared_->mutex);
  shared_->stop = true;
  shared_->changed.notify_all();
  shared_->changed.wait_for(lock, seconds(3), [&] { return shared_->finished; });
}

Fed Feed::take(GrayFrame& frame, double wait) {
  std::unique_lock lock(shared_->mutex);
  Shared& s = *shared_;
  s.changed.wait_for(lock, seconds(wait), [&] { return s.slot || s.ended; });
  if (s.slot) {
    frame = std::move(*s.slot);
    s.slot.reset();
    s.changed.notify_all();
    return Fed::frame;
  }
  return s.ended ? Fed::end : Fed::nothing;
}

}  // namespace wellspring::kiosk
