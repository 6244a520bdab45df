// SPDX-License-Identifier: Apache-2.0
// A camera read in a thread of its own, so that a device that hangs never hangs the kiosk. A live
// camera: the newest frame wins and a lost one is tried again every second. Anything else: every
// frame in order, at the pace of its times or as fast as they are taken.
#pragma once
#include <memory>

#include "kiosk/camera.h"

namespace wellspring::kiosk {

enum class Fed : uint8_t {
  frame,
  nothing,  // none within the wait
  end,
};

class Feed {
 public:
  Feed(std::unique_ptr<Camera> camera, bool pace);
  ~Feed();  // waits for the reading thread, but not for a driver that hangs
  // Waits up to `seconds` for the next frame.
  Fed take(GrayFrame& frame, double seconds);

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace wellspring::kiosk
