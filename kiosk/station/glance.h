// SPDX-License-Identifier: Apache-2.0
// Says cheaply whether a look may find something new: whether anything as large as an object has
// come into the picture since the last look that found nothing. It compares means of small cells,
// 0.3 ms a frame.
#pragma once
#include <cstdint>
#include <vector>

#include "kiosk/frame/head.h"

namespace wellspring::kiosk {

class Glance {
 public:
  // Takes frames, ten a second or more.
  void step(const GrayFrame& frame);
  // A block of cells differs from the picture that was looked at in vain; true before there is one.
  bool changed() const { return changed_; }
  // Hardly anything moves: what is held up is held still.
  bool rests() const { return rests_; }
  // The look at the last frame found nothing.
  void note_vain() { vain_ = now_, changed_ = false; }

 private:
  bool differs(const std::vector<float>& from, int least_blocks) const;

  int width_ = 0, height_ = 0;              // size of the picture; another begins anew
  int across_ = 0, down_ = 0;               // cells
  double before_at_ = -1e9;                 // time of `before_`
  std::vector<float> now_, before_, vain_;  // mean brightness of each cell; empty: none yet
  bool changed_ = true, rests_ = false;
};

}  // namespace wellspring::kiosk
