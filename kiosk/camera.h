// SPDX-License-Identifier: Apache-2.0
// Reads frames from a webcam, a video file, a folder of pictures or the synthetic room, behind one
// call.
#pragma once
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "kiosk/frame/head.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

enum class Got : uint8_t {
  frame,
  end,   // a file or a folder has ended
  lost,  // the device is not there or stopped; the next call tries to open it again
};

class Camera {
 public:
  virtual ~Camera() = default;
  // Blocks until there is a frame, at most about two seconds for a device. `frame` keeps its
  // memory.
  virtual Got next(GrayFrame& frame) = 0;
  // Returns whether it runs on a clock of its own, as devices do; the others' times begin at 0.
  virtual bool live() const = 0;
  virtual std::string name() const { return "camera"; }  // for messages
};

struct CameraSettings {
  std::string name;  // for people
  // Number of a V4L2 device, a device's path, a file, a folder, "synthetic", or "synthetic-live":
  // the same at a device's pace, with the times of the machine's monotonic clock.
  std::string source;
  int width = 640;  // request to a device; wider frames are brought down to it
  // frames a second: a request to a device; the rate of a folder and of the synthetic camera
  double rate = 30;
  bool loop = false;            // a file or a folder starts again at its end; times go on
  bool synthetic_ends = false;  // the synthetic camera ends after one round
  Mount mount;  // its roll turns pictures upright; the synthetic camera is mounted by all of it
};

// Opens a camera. A folder's .png, .jpg and .jpeg files are played in the order of their names; one
// that cannot be read is logged and left out. Throws LoadError for a file that is missing or holds
// no picture, and for a folder without any. A device that is not there is no error: next() says
// lost.
std::unique_ptr<Camera> make_camera(const CameraSettings& settings);

// Finds faults of a camera from its pictures alone, so that a technician need not guess.

class CameraWatch {
 public:
  static constexpr double told_after = 3;  // seconds that a fault must last
  static constexpr double least_rate = 8;  // pictures a second
  // Takes the next frame; its time may run backwards if a file begins again.
  CameraState step(const GrayFrame& frame);
  // Notes that there has been no picture for long.
  CameraState step_blind();

 private:
  std::vector<uint8_t> before_, now_;  // a pixel in 16
  double dark_since_ = 0, same_since_ = 0, begun_ = 0;
  std::deque<double> times_;  // times of the last frames
};

// Reads a camera in a thread of its own, so that a device that hangs never hangs the kiosk. From a
// live camera the newest frame wins, and a lost one is tried again every second. Anything else
// gives every frame in order, at the pace of its times or as fast as they are taken.

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
