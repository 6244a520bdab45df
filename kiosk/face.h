// SPDX-License-Identifier: Apache-2.0
// Faces in a picture, by the cascades of Debian's opencv-data (Viola and Jones 2001; Liao et al.
// 2007 for LBP): a quick LBP search proposes, a Haar cascade confirms; around a face already
// followed Haar alone searches a small window. All that the rest of the kiosk knows of detection is
// in this header, so another detector can stand here.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "kiosk/gray_frame.h"

namespace wellspring {

enum class FaceView : uint8_t {
  frontal,
  image_left,
  image_right
};  // a profile looks to that side of the image

struct Face {
  Box box;  // the frontal cascade's square
  FaceView view = FaceView::frontal;
  float confidence = 0;                     // 0..1: how clearly the cascade answered
  std::optional<std::array<vec2, 2>> eyes;  // pixels: the eye at image left, then at image right
};

struct FaceSettings {
  std::string cascades = "/usr/share/opencv4";
  int search_width = 320;     // whole frames are searched at this width
  float smallest = 1 / 13.f;  // box side over frame width: smaller faces are too far away to greet
};

class FaceFinder {
 public:
  // Throws LoadError naming the cascade's path and the package that brings it.
  explicit FaceFinder(const FaceSettings& settings = {});
  ~FaceFinder();
  // Everything in the frame; about 8 ms. Largest first, at most 8.
  std::vector<Face> search(const GrayFrame& frame);
  // The same within `zone`, with the slower and more sensitive Haar cascade alone.
  std::vector<Face> search_thoroughly(const GrayFrame& frame, const Box& zone);
  // The face near `last` (one frame to half a second later), frontal or in profile; about 2 ms.
  // `roll` is how far the head was tilted (positive: its top towards image left); the cascades know
  // upright faces, so the window is turned back by it.
  std::optional<Face> follow(const GrayFrame& frame, const Box& last, float roll = 0);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring
