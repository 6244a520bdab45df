// SPDX-License-Identifier: Apache-2.0
// Finds what the volumes of a world add to pictures that are drawn without them: marches from the
// eye to the surface that a pixel shows (volume/draw/march.h).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cache/project.h"
#include "frame/frame.h"
#include "world/placed_volume.h"
#include "world/view.h"

namespace wellspring::picture {

// Holds what is laid over eight pixels.
struct Laid {
  Lanes3 light;                       // linear
  Lanes clear = all_lanes(1);         // share of the light behind that comes through
  Lanes depth = all_lanes(INFINITY);  // metres along the axis until half is absorbed
  LaneBits object{};                  // seen there, where `depth` is finite
};

class VolumeView {
 public:
  VolumeView() = default;
  // Borrows `volumes`. `settled`: the view stands still, so that steps are short and the level is
  // fine. `turn`: number of the picture among those whose mean is shown.
  VolumeView(std::span<const PlacedVolume> volumes, const View& view, bool settled, uint32_t turn);

  // Returns whether any pixel of [x, x + count) in row y may show a volume.
  bool shows(int x, int y, int count) const;
  PictureWindow window() const { return all_; }  // around all that may show a volume
  // Looks at eight pixels from (x, y) on, at `offset` in each of them, as far as `surface`: metres
  // along the axis, infinity: nothing is there.
  Laid look(int x, int y, vec2 offset, const Lanes& surface) const;

 private:
  struct Seen {
    const PlacedVolume* placed;
    ToVolume to_volume;
    Bounds bounds;
    PictureWindow window;
    int level = 0;
    bool joint = false;  // its bounds and those of the next one overlap
  };
  struct Rays {
    Lanes3 way;       // unit, in the scene
    Lanes length;     // metres along a ray to one of depth
    Lanes near, far;  // metres
    Lanes jitter;
  };
  float step_in_samples() const;          // counted in the level
  float step_of(const Seen& seen) const;  // metres
  MarchedLight march_one(const Seen& seen, const Rays& rays) const;
  void add(const Seen& seen, const Rays& rays, Laid& laid) const;
  void add_jointly(std::span<const Seen> group, const Rays& rays, Laid& laid) const;

  View view_;
  bool settled_ = false;
  uint32_t turn_ = 0;
  std::vector<Seen> seen_;  // the nearest first
  PictureWindow all_;
};

}  // namespace wellspring::picture
