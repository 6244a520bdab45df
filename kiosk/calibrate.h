// SPDX-License-Identifier: Apache-2.0
// Finds how the camera sits from a person who stands still at two marks straight before the middle
// of the screen and looks at it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "kiosk/frame/head.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

// The marks are so many metres from the screen.
inline constexpr float near_mark = 1, far_mark = 2;

// Solves for the camera's field of view, pitch and place from observations at the marks through
// `mount`, in metres on the screen. Its height above the screen's centre is solved for only if the
// person's eyes are known to be `eyes` above it. Throws std::runtime_error if no such camera could
// see that, or if it looks to the side by more than 5 degrees.
Mount solve_mount(const Mount& mount, vec3 at_near, vec3 at_far, std::optional<float> eyes = {});

// Waits for the person at one mark after the other. Time is that of the observations.
class Calibration {
 public:
  // Takes the next observation. True: both marks are known.
  bool step(const Observation& seen);
  // Returns what the person is to do, in words for the terminal and as the kiosk's screen shows it.
  std::string advice() const;
  CalibrationStep now() const;
  vec3 at_near() const { return found_[0]; }
  vec3 at_far() const { return found_[1]; }

 private:
  struct Look {
    double time;
    vec3 place;
  };
  std::vector<Look> looks_;
  std::vector<vec3> found_;
};

}  // namespace wellspring::kiosk
