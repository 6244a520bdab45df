// SPDX-License-Identifier: Apache-2.0
// Lays what is no mesh over pictures that are drawn without it: points of scans
// (picture/scan_view.h), grass (picture/grass_view.h), then volumes before them
// (picture/volume_view.h), and, once a picture is whole, splats (picture/splat_view.h).
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "picture/grass_view.h"
#include "picture/scan_view.h"
#include "picture/splat_view.h"
#include "picture/volume_view.h"

namespace wellspring::picture {

struct Shown;  // picture/drawn_planes.h

// Borrows what stands in a world beside its meshes.
struct LaidThings {
  std::span<const PlacedVolume> volumes;
  ShownScans scans;
  float exposure = 1;  // as frame/tonemap.h has it
  std::span<const ShownLawn> lawns;
  // Returns the bounds of what may shade scans and lawns.
  Bounds moving() const {
    return scans.world && !(scans.all().empty() && lawns.empty()) ? scans.world->moving_bounds()
                                                                  : Bounds{};
  }
  bool empty() const { return volumes.empty() && scans.all().empty() && lawns.empty(); }
};
inline LaidThings laid_things(const World& world, const Lights* lights,
                              std::shared_ptr<const IlluminationMap> maps, float exposure,
                              std::span<const ShownLawn> lawns = {}) {
  return {world.volumes(), {&world, lights, std::move(maps)}, exposure, lawns};
}

// Keeps memory from one picture to the next.
struct LaidWork {
  ScanWork scans;
  SplatWork splats;
  LawnWork lawns;
  size_t memory_bytes() const {
    return scans.memory_bytes() + splats.memory_bytes() + lawns.memory_bytes();
  }
};

class LaidView {
 public:
  LaidView() = default;
  // Borrows `things`, and uses `work` as long as it lives. Pixels are seen at `offset` in them.
  // `settled`: the view stands still, so that it may take longer. `turn`: number of the picture
  // among those whose mean is shown. `before`: as GrassView has it; `dynamic`: as ScanView.
  LaidView(const LaidThings& things, const View& view, vec2 offset, bool settled, uint32_t turn,
           LaidWork& work, std::span<const float> before = {},
           const DynamicImage* dynamic = nullptr);

  // Returns whether any pixel of [x, x + count) in row y may show something.
  bool shows(int x, int y, int count) const {
    return scans_.any() || volumes_.shows(x, y, count) || grass_.shows(x, y, count);
  }
  // Looks at eight pixels from (x, y) on, as far as `surface`: metres along the axis, infinity:
  // nothing is there.
  Laid look(int x, int y, const Lanes& surface) const;
  // Lays it over these pixels.
  void lay_over(int x, int y, Shown& shown) const;

 private:
  View view_;
  vec2 offset_{0.5f};
  VolumeView volumes_;
  ScanView scans_;
  GrassView grass_;
};

// Keeps the mean of what is laid over a view that stands still, each time seen at another place of
// its pixels.
class LaidLayer {
 public:
  // Looks from so many more places of the pixels, unless there were enough, and lays the mean over
  // the frame, and splats over that. Begins anew if the view or the looks have changed, more has
  // been read, or what shades it has moved.
  void lay_over(const LaidThings& things, const View& view, int places, LaidWork& work,
                Frame& frame);
  size_t memory_bytes() const;

 private:
  bool begins(const LaidThings& things, const View& view);
  void add(const LaidView& laid, const Frame& frame);
  void lay_mean_over(Frame& frame) const;

  View view_;
  std::vector<VolumeLook> looks_;
  std::vector<ScanLook> scan_looks_;
  std::vector<std::pair<std::shared_ptr<const LawnLight>, uint64_t>> lawns_;  // and their moments
  Bounds moving_;
  std::shared_ptr<const IlluminationMap> maps_;
  PictureWindow window_;
  uint64_t arrivals_ = 0;  // bricks that have come, of all volumes
  uint32_t pictures_ = 0;
  // Sums for each pixel of the window.
  std::vector<vec3> color_;
  std::vector<float> clear_;
  std::vector<float> depth_;  // the last picture's; infinity: the surface's
  std::vector<uint32_t> object_;
  SplatLayer splats_;
};

}  // namespace wellspring::picture
