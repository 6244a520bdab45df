// SPDX-License-Identifier: Apache-2.0
// Draws the scans of a world for a picture that is drawn without them: their points become discs
// with depth and colour (scan/draw/draw_points.h), nodes of their trees as fine as pixels. Those
// that are lit get the light of illumination maps around them (light/kept/stand_in_light.h), and
// that of lights that move. All are shaded by what moves (light/kept/moving_shade.h).
#pragma once
#include <cmath>
#include <list>
#include <memory>
#include <span>
#include <vector>

#include "base/simd.h"
#include "light/kept/moving_shade.h"
#include "light/kept/stand_in_light.h"
#include "light/virtual/dynamic_image.h"
#include "picture/lit_blocks.h"
#include "scan/camera.h"
#include "scan/draw/draw_points.h"
#include "world/placed_scan.h"
#include "world/view.h"

namespace wellspring::picture {

struct Keyframe;  // picture/keyframe.h

// Returns the camera of a view in the scene's own frame.
ScanCamera camera_of(const View& view);

// Borrows the scans of a world, its lights, and the maps that light them; without these,
// reflectance is shown as it were captured.
struct ShownScans {
  const World* world = nullptr;
  const Lights* lights = nullptr;
  std::shared_ptr<const IlluminationMap> maps;
  std::span<const PlacedScan> all() const {
    return world ? world->scans() : std::span<const PlacedScan>();
  }
  // Returns the bounds of what may shade them.
  Bounds moving() const { return world && !all().empty() ? world->moving_bounds() : Bounds{}; }
};

// Returns the window in which what moves may shade what it stands on.
PictureWindow shaded_window(const MovingShade& shade, const View& view);
// Returns whether what moves is elsewhere now, by more than it sways.
bool has_moved(const Bounds& before, const Bounds& now);

// Keeps the memory that is needed while a picture is drawn, and light that was found for others.
struct ScanWork {
  struct Known {
    std::shared_ptr<const IlluminationMap> map;
    int stand_in = -1;
    std::shared_ptr<const StandInLight> light;
  };
  PointRaster raster;
  std::vector<PointBuffer> buffers;  // for each scan that is seen
  std::vector<LitBlocks> blocks;     // likewise
  std::list<Known> known;            // the one used last comes first
  // The light of lights that move.
  SurfaceBuffer surfaces;
  SplatPicture bounce;
  LightPlanes light;
  size_t memory_bytes() const;
};

// Holds what eight pixels see of scans.
struct SeenScan {
  Lanes3 light{};                     // linear
  Lanes depth = all_lanes(INFINITY);  // metres along the axis; infinity: nothing
  LaneBits object{};
};

// Holds what a pixel sees of a scan.
struct ScanSurface {
  float depth = INFINITY;  // metres along the axis; infinity: nothing
  vec3 normal{0};          // unit, towards the eye
  vec3 reflectance{0};     // 0: light of its own
  uint32_t object = 0;
};

class ScanView {
 public:
  ScanView() = default;
  // Borrows `scans` and `work`, which nobody else may use as long as this lives. Pixels are seen at
  // `offset` in them. `settled`: the view stands still, so that it may take longer. `dynamic`: the
  // light of lights that move, sent into the world for this view; null: there are none.
  ScanView(const ShownScans& scans, const View& view, vec2 offset, bool settled, ScanWork& work,
           const DynamicImage* dynamic = nullptr);

  bool any() const { return !seen_.empty(); }
  SeenScan look(int x, int y) const;  // eight pixels from (x, y) on
  ScanSurface surface(int x, int y) const;

 private:
  struct Seen {
    const PlacedScan* placed;
    const PointBuffer* buffer;
    float lowest, height;               // metres of the scene
    mat3 turn{1};                       // from the scan to the scene
    const LitBlocks* blocks = nullptr;  // null: it is neither lit nor shaded
    float usual = 1;                    // light where none is known
    bool is_lit = false;                // all of it, by blocks
  };
  void light(const ShownScans& scans, const MovingShade& shade, const DynamicImage* dynamic,
             Seen& seen, LitBlocks& blocks, ScanWork& work) const;
  vec3 normal_at(const Seen& one, int x, int y) const;
  Lanes3 normals_at(const Seen& one, int x, int y, const Lanes& depth) const;
  vec3 color_at(const Seen& one, int x, int y, float depth) const;

  std::vector<Seen> seen_;
  View view_;
  vec2 offset_{0.5f};
};

// Lets lights that move light scans in a picture at rest, too: puts them before what the backdrop
// of `keyframe` has, which shows them.
void lay_scans_over(const ShownScans& scans, const Keyframe& keyframe, ScanWork& work,
                    BackdropSurfaces& backdrop);

}  // namespace wellspring::picture
