// SPDX-License-Identifier: Apache-2.0
// Draws lawns for a picture that is drawn without them (lawn/draw_lawn.h), in their light
// (picture/grass_light.h).
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/simd.h"
#include "cache/project.h"
#include "lawn/draw_lawn.h"
#include "picture/grass_light.h"
#include "picture/keyframe.h"
#include "world/view.h"

namespace wellspring::picture {

// Returns the window in which lawns may show; it is empty if none does.
PictureWindow lawn_window(std::span<const ShownLawn> lawns, const View& view);
// Returns whether rays through some of the window's pixels reach a lawn before anything else does.
bool sees_lawns(const World& world, std::span<const ShownLawn> lawns, const View& view);

// Keeps the memory that is needed while a picture is drawn.
struct LawnWork {
  struct Layer {
    PictureWindow window;
    LawnPicture picture;  // colours become radiance
    bool drawn = false;   // it is of the last view
  };
  LawnDrawer drawer;
  std::vector<Layer> layers;  // one for each lawn
  std::vector<float> before;  // depth in a window
  GrassLightWork light;
  size_t memory_bytes() const;
};

// Holds what eight pixels see of lawns.
struct SeenLawn {
  Lanes3 light{};                     // linear, times `cover`
  Lanes cover{};                      // share of the pixel
  Lanes depth = all_lanes(INFINITY);  // metres along the axis; infinity: nothing
  LaneBits object{};
};

class GrassView {
 public:
  GrassView() = default;
  // Borrows `lawns` and `work`, which nobody else may use as long as this lives. Draws nothing if
  // nothing of them is to be seen in the world. `before`: depth of each pixel of a picture that is
  // one of those whose mean is shown, seen at `offset`: blades are exact then; empty: they cover
  // pixels in part.
  GrassView(std::span<const ShownLawn> lawns, const GrassWorld& world, const View& view,
            vec2 offset, std::span<const float> before, LawnWork& work);

  bool any() const { return !layers_.empty(); }
  // Returns whether any pixel of [x, x + count) in row y may show grass.
  bool shows(int x, int y, int count) const;
  SeenLawn look(int x, int y) const;  // eight pixels from (x, y) on

 private:
  struct Seen {
    const LawnWork::Layer* layer;
    uint32_t object;
  };
  std::vector<Seen> layers_;
};

// Returns how wind moves the grass that the last GrassView has drawn with `work` for the keyframe.
SwayImage find_sway(std::span<const ShownLawn> lawns, const LawnWork& work,
                    const Keyframe& keyframe);

}  // namespace wellspring::picture
