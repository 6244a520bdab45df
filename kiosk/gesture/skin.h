// SPDX-License-Identifier: Apache-2.0
// The colour of somebody's skin, learnt from the face: one Gaussian over Cb and Cr.
#pragma once
#include "kiosk/gesture/mean_shift.h"

namespace wellspring::kiosk {

class SkinColor {
 public:
  // Adds the face of that centre and side (pixels) to what is known; the newest second counts most.
  // Eyes, lips and hair are left out as far as they differ from most of it.
  void learn(const ChromaPicture& picture, vec2 center, float side);
  // Is this skin? Never before a face was learnt, and never where it is too dark to tell.
  bool has(uint8_t y, uint8_t cb, uint8_t cr) const;
  vec2 mean() const { return mean_; }  // Cb, Cr

 private:
  bool known_ = false;
  vec2 mean_{0};
  vec3 spread_{0};  // variance of Cb, covariance, variance of Cr
};

}  // namespace wellspring::kiosk
