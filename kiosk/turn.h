// SPDX-License-Identifier: Apache-2.0
// Which way a head is turned, as the lens sees it. Points of the face are followed by optical flow
// (Lucas and Kanade 1981) and a rigid ellipsoid of a head's size is fitted to them (after Xiao,
// Moriyama, Kanade, Cohn 2003, "Robust full-motion recovery of head by dynamic templates"), weak
// perspective, Tukey weights. Flow knows changes well and the zero badly; cues from single frames
// are crude but do not drift. The two are joined by a slow pull:
//   roll    from the line between the eyes,
//   yaw     from the midline of nose and mouth against the middle of the eyes; profile views
//   beyond, pitch   towards that of somebody who looks at the screen, since visitors do on the
//   whole.
// Measured on the synthetic figure, root mean square of yaw, pitch, roll in degrees: 7, 4, 1 with a
// level camera, 8, 3, 4 with one 0.35 m above the screen tilted down by 20. There is no measured
// truth for people; a head kept turned drifts back by about half within 4 to 8 seconds.
#pragma once
#include <memory>

#include "base/vec.h"
#include "kiosk/face.h"

namespace wellspring {

class Turn {
 public:
  Turn();
  ~Turn();
  Turn(Turn&&) noexcept;
  Turn& operator=(Turn&&) noexcept;
  // `face` is where the head is in `frame`; `detected` tells a fresh detection from one carried on;
  // `previous` is the frame of the last call's time (or any other size or age: the points then
  // start anew). About 2 ms. Returns the rotation, identity for a face that looks into the lens, in
  // that visitor's axes (head.h, rotation_on_screen). `rest` is the pitch, as the lens sees it, of
  // somebody there who looks at the screen.
  mat3 step(const GrayFrame& previous, const GrayFrame& frame, const Face& face, bool detected,
            float rest = 0);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Yaw in radians (positive: towards the visitor's right, image left) from one frame: where the
// mirror axis of the nose lies between the eyes, within 0.5. Nothing where the axis is not clear.
// Crude: about 10 degrees, and shrunk towards 0.
std::optional<float> yaw_of_midline(const GrayFrame& frame, const Face& face);

}  // namespace wellspring
