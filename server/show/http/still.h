// SPDX-License-Identifier: Apache-2.0
// Finished pictures on request (still.jpg): their own copy of the world, so that a running show is
// never waited for; at most half of the cores; the last few are remembered. Thread-safe; may take
// seconds.
#pragma once
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "show/state/show.h"

namespace wellspring {

struct StillJob {
  int viewpoint = 0, width = 640, height = 360, spp = 16;
  bool denoise = true;  // where there are weights, else nothing is done
  // In place of the viewpoint's own; metres, radians.
  std::optional<dvec3> position;
  std::optional<float> yaw, pitch, fov;
  bool operator==(const StillJob&) const = default;
};

class StillRoom {
 public:
  // Borrows `show`'s exhibit for its lifetime (not its world, which moves). The storyteller who is
  // there stands in its first pose, and lamps are as at first. Bounds of an order: see
  // still_question.cpp.
  explicit StillRoom(const Show& show);
  // JPEG bytes, whose comment says whether it was denoised. One picture at a time; later callers
  // wait.
  std::string make(const StillJob& order);

 private:
  struct Kept {
    StillJob order;
    std::string jpeg;
  };
  std::mutex mutex_;
  const Exhibit& exhibit_;
  const Technique* technique_;
  TransportSettings transport_;
  std::string weights_;
  std::unique_ptr<World> world_;
  Lights lights_;
  Frame render(const StillJob& order, std::string& comment) const;
  std::list<Kept> kept_;  // newest first
};

}  // namespace wellspring
