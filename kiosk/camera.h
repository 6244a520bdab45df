// SPDX-License-Identifier: Apache-2.0
// Where frames come from: a webcam, a video file, a folder of pictures or the synthetic room,
// behind one call.
#pragma once
#include <memory>
#include <string>

#include "kiosk/frame/gray_frame.h"
#include "kiosk/frame/head.h"

namespace wellspring::kiosk {

enum class Got : uint8_t {
  frame,
  end,   // of a file or a folder
  lost,  // the device is not there or stopped; asking again tries to open it again
};

class Camera {
 public:
  virtual ~Camera() = default;
  // Blocks until there is a frame, at most about two seconds for a device. `frame` keeps its
  // memory.
  virtual Got next(GrayFrame& frame) = 0;
  // A device runs on a clock of its own; everything else has times of its own, from 0.
  virtual bool live() const = 0;
  virtual std::string name() const { return "camera"; }  // for messages
};

struct CameraSettings {
  std::string name;  // for people
  // Number of a V4L2 device, a device's path, a file, a folder, "synthetic", or "synthetic-live":
  // the same at a device's pace, with the times of the machine's monotonic clock.
  std::string source;
  int width = 640;              // asked of a device; wider frames are brought down to it
  double rate = 30;             // frames a second asked of a device; of a folder, the synthetic one
  bool loop = false;            // a file or a folder starts again at its end; times go on
  bool synthetic_ends = false;  // the synthetic camera ends after one round
  Mount mount;                  // of the synthetic camera
};

// A folder's .png, .jpg and .jpeg files are played in the order of their names; one that cannot be
// read is logged and left out. Throws LoadError for a file that is missing or holds no picture, and
// for a folder without any. A device that is not there is no error: next() says lost.
std::unique_ptr<Camera> make_camera(const CameraSettings& settings);

}  // namespace wellspring::kiosk
