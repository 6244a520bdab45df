// SPDX-License-Identifier: Apache-2.0
// Finished pictures on request (still.jpg): their own copy of the world, so that a running show is
// never waited for; the last few are remembered. Who may ask for how much is the desk's
// (show/http/still_desk.h). Thread-safe; may take minutes.
#pragma once
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>

#include "show/state/show.h"

namespace wellspring {

struct StillJob {
  int viewpoint = 0, width = 640, height = 360, spp = 16;
  bool denoise = true;  // where there are weights, else nothing is done
  // In place of the viewpoint's own; metres, radians.
  std::optional<dvec3> position;
  std::optional<float> yaw, pitch, roll, fov;
  bool operator==(const StillJob&) const = default;
  double pixels() const { return double(width) * height; }
};

// What pictures take: seconds of the thread that makes them, so that others' work does not count.
struct StillCosts {
  double trace_seconds = 0, denoise_seconds = 0;  // the latter without samples: guides, network
};

class StillRoom {
 public:
  // Borrows `show`'s exhibit for its lifetime (not its world, which moves). The storyteller who is
  // there stands in its first pose, and lamps are as at first. Bounds of an order: see
  // still_question.cpp.
  explicit StillRoom(const Show& show);
  // JPEG bytes, whose comment says whether it was denoised, on at most `cores`. Empty: given up, as
  // `given_up` (any thread, every few milliseconds) said so.
  std::string make(const StillJob& order, const std::function<bool()>& given_up = {}, int cores = 1,
                   StillCosts* costs = nullptr);
  // Of a small picture that is made, and not remembered.
  StillCosts measure(const StillJob& order);
  std::optional<std::string> find(const StillJob& order);  // among those that are remembered
  bool denoises() const { return !weights_.empty(); }

 private:
  struct Kept {
    StillJob order;
    std::string jpeg;
  };
  std::optional<Frame> render(const StillJob& order, const std::function<bool()>& given_up,
                              StillCosts& costs, std::string& comment) const;
  const Exhibit& exhibit_;
  const Technique* technique_;
  TransportSettings transport_;
  std::string weights_;
  std::unique_ptr<World> world_;
  Lights lights_;
  std::mutex mutex_;      // of what follows
  std::list<Kept> kept_;  // newest first
};

}  // namespace wellspring
