// SPDX-License-Identifier: Apache-2.0
// Sees bodies in front of the camera: the network where body_tracks.h wants it, frame by frame.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "kiosk/body/body_marks.h"
#include "kiosk/body/body_tracks.h"

namespace wellspring::kiosk {

class BodyWatch {
 public:
  // Throws LoadError as BodyReader does.
  BodyWatch(const std::string& folder, const Mount& mount, const BodySettings& settings = {})
      : reader_(folder), tracks_(mount, settings) {}
  // Takes a frame: about 10 ms where the network is run, next to nothing elsewhere. `arms`: the
  // wrists of the first face are needed.
  void step(const GrayFrame& frame, std::span<const Box> zones, std::span<const FaceInView> faces,
            bool arms) {
    const auto look = tracks_.plan(frame.time, frame.width, frame.height, zones, faces, arms);
    if (!look) return;
    const GrayView picture{frame.pixels.data(), frame.width, frame.height};
    const TintView tint{frame.bgr.data(), frame.color_width, frame.color_height};
    tracks_.take(frame.time, reader_.read(picture, tint, look->square, look->most), faces);
  }
  const BodyTracks& tracks() const { return tracks_; }

 private:
  BodyReader reader_;
  BodyTracks tracks_;
};

}  // namespace wellspring::kiosk
