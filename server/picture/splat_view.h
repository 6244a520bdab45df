// SPDX-License-Identifier: Apache-2.0
// Lays the Gaussian splats of a world over finished pictures (scan/splat_draw/draw_splats.h): they
// are blended in display codes, as they were trained, and stop at the depth that a picture has.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "frame/frame.h"
#include "picture/lit_blocks.h"
#include "scan/splat_draw/draw_splats.h"
#include "world/placed_scan.h"
#include "world/view.h"

namespace wellspring::picture {

struct ShownScans;  // picture/scan_view.h

// Keeps memory from one picture to the next.
struct SplatWork {
  SplatDrawer drawer;
  SplatPlanes picture;
  LitBlocks blocks;
  size_t memory_bytes() const;
};

bool has_splats(std::span<const PlacedScan> scans);
// Returns the object of the first set that is shown: a picture does not tell sets apart.
uint32_t splat_object(std::span<const PlacedScan> scans);

// Lays splats over a picture for the eye and its depth, metres along the axis. They are shaded by
// all that moves, as if they were a floor.
void lay_splats_over(const ShownScans& scans, const View& view, SplatWork& work, Image8& image,
                     std::vector<float>& depth);

// Keeps the splats of a view that stands still, in each pixel's own order.
class SplatLayer {
 public:
  // Lays them over a linear frame, of which `exposure` times 1 is a display's white. Draws them
  // anew if the view or the looks have changed, or what shades them has moved.
  void lay_over(const ShownScans& scans, const View& view, float exposure, SplatWork& work,
                Frame& frame);
  void forget() { drawn_ = false; }
  size_t memory_bytes() const;

 private:
  View view_;
  bool drawn_ = false;
  std::vector<ScanLook> looks_;
  Bounds moving_;
  SplatPlanes picture_;
};

}  // namespace wellspring::picture
