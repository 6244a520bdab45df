// SPDX-License-Identifier: Apache-2.0
// Draws the scans of a world for a picture that is drawn without them: their points become discs
// with depth and colour (scan/draw/draw_points.h), nodes of their trees as fine as pixels. Those
// that are lit get the light of illumination maps around them (light/kept/stand_in_light.h), found
// for every fourth pixel across and down.
#pragma once
#include <list>
#include <memory>
#include <span>
#include <vector>

#include "base/simd.h"
#include "light/kept/stand_in_light.h"
#include "scan/camera.h"
#include "scan/draw/draw_points.h"
#include "world/placed_scan.h"
#include "world/view.h"

namespace wellspring::picture {

// Returns the camera of a view in the scene's own frame.
ScanCamera camera_of(const View& view);

// Borrows the scans of a world, and the maps that light them; without these, reflectance is shown
// as it were captured.
struct ShownScans {
  const World* world = nullptr;
  std::shared_ptr<const IlluminationMap> maps;
  std::span<const PlacedScan> all() const {
    return world ? world->scans() : std::span<const PlacedScan>();
  }
};

// Holds the light on a block of pixels of a scan, as a surface there that faces along `normal` gets
// it.
struct LitBlock {
  vec3 light{0}, slope{0}, normal{0};
  float depth = 0;  // metres along the axis; 0: the block shows nothing whose light is known
};

// Keeps the memory that is needed while a picture is drawn, and light that was found for others.
struct ScanWork {
  struct Known {
    std::shared_ptr<const IlluminationMap> map;
    int stand_in = -1;
    std::shared_ptr<const StandInLight> light;
  };
  PointRaster raster;
  std::vector<PointBuffer> buffers;           // for each scan that is seen
  std::vector<std::vector<LitBlock>> blocks;  // likewise
  std::list<Known> known;                     // the one used last comes first
  size_t memory_bytes() const;
};

// Holds what eight pixels see of scans.
struct SeenScan {
  Lanes3 light{};                     // linear
  Lanes depth = all_lanes(INFINITY);  // metres along the axis; infinity: nothing
  LaneBits object{};
};

class ScanView {
 public:
  ScanView() = default;
  // Borrows `scans` and `work`, which nobody else may use as long as this lives. Pixels are seen at
  // `offset` in them. `settled`: the view stands still, so that it may take longer.
  ScanView(const ShownScans& scans, const View& view, vec2 offset, bool settled, ScanWork& work);

  bool any() const { return !seen_.empty(); }
  SeenScan look(int x, int y) const;  // eight pixels from (x, y) on

 private:
  struct Seen {
    const PlacedScan* placed;
    const PointBuffer* buffer;
    float lowest, height;                           // metres of the scene
    mat3 turn{1};                                   // from the scan to the scene
    const std::vector<LitBlock>* blocks = nullptr;  // null: it is not lit
    float usual = 0;                                // light where none is known
  };
  void light_blocks(const StandInLight& light, const Seen& seen,
                    std::vector<LitBlock>& blocks) const;
  vec3 normal_at(const Seen& one, int x, int y) const;
  vec3 color_at(const Seen& one, int x, int y, float depth) const;
  Lanes3 light_at(const Seen& one, int x, int y, const Lanes& depth) const;

  std::vector<Seen> seen_;
  View view_;
  vec2 offset_{0.5f};
};

}  // namespace wellspring::picture
