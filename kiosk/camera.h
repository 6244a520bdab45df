// SPDX-License-Identifier: Apache-2.0
// Where frames come from: a webcam, a video file or the synthetic room, behind one call.
#pragma once
#include <memory>
#include <string>

#include "kiosk/gray_frame.h"
#include "kiosk/head.h"

namespace wellspring {

enum class Got : uint8_t {
  frame,
  end,   // of a file
  lost,  // the device is not there or stopped; asking again tries to open it again
};

class Camera {
 public:
  virtual ~Camera() = default;
  // Blocks until there is a frame, at most about two seconds for a device. `frame` keeps its
  // memory.
  virtual Got next(GrayFrame& frame) = 0;
  // A device runs on its own clock (seconds_now()); everything else has times of its own, from 0.
  virtual bool live() const = 0;
  virtual std::string name() const { return "camera"; }  // for messages
};

struct CameraSettings {
  std::string source;           // number of a V4L2 device, a device's path, a file, or "synthetic"
  int width = 640;              // asked of a device; wider frames are brought down to it
  double rate = 30;             // frames a second asked of a device and made by the synthetic one
  bool loop = false;            // a file starts again at its end; times go on
  bool synthetic_ends = false;  // the synthetic camera ends after one round
  Mount mount;                  // of the synthetic camera
};

// Throws LoadError for a file that is missing or holds no picture. A device that is not there is no
// error: next() says lost.
std::unique_ptr<Camera> make_camera(const CameraSettings& settings);

}  // namespace wellspring
