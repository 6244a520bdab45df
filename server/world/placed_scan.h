// SPDX-License-Identifier: Apache-2.0
// A scanned place or thing that stands in the scene, as points or as Gaussian splats, and what is
// seen of it. The eye sees points and splats, which pictures lay over what they draw
// (picture/laid_view.h); all other rays meet a mesh in the place of them (Mesh::stands_in).
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "scan/camera.h"
#include "world/scene.h"

namespace wellspring::scan {
struct PointTree;    // scan/tree/point_tree.h
struct ShownSplats;  // scan/splat_draw/draw_shown.h
}  // namespace wellspring::scan

namespace wellspring::world {

// Says what the colours of a scan's points mean.
enum class ScanColors : uint8_t {
  captured,        // light that the scanner saw: shown as it is
  lit,             // reflectance, on which the scene's light falls
  intensity,       // how much of the scanner's own light came back
  height,          // metres above the scan's lowest point, as a scale of colours
  classification,  // a point's class, by codes of ASPRS
};

struct ScanLook {
  ScanColors colors = ScanColors::captured;
  float brightness = 1;       // radiance of white, captured
  int set = 0;                // index into PlacedScan::sets
  std::vector<ScanCut> cuts;  // in scene coordinates: only what all of these keep is seen
  bool operator==(const ScanLook&) const = default;
};

// One of a scan's sets of points, as of a day of a dig.
struct ScanSet {
  std::shared_ptr<const PointTree> points;
  dvec3 offset{0};  // its zero in the first set's frame, the scan's own metres
};

struct PlacedScan {
  std::vector<ScanSet> sets;                  // empty: it is one of splats
  std::shared_ptr<const ShownSplats> splats;  // null: it has sets of points
  float sphere = 0;         // the scan's own metres; above 0: points are spheres of that radius
  vec3 position{0};         // the scan's own zero is there, scene coordinates
  quat turn{1, 0, 0, 0};    // from its own axes to the scene's, unit
  float scale = 1;          // metres of the scene to one of the scan
  float low = 0, high = 0;  // heights between which its points lie, its own metres
  uint32_t object = 0;      // seen there
  int stand_in = -1;        // instance of the scene that rays meet; -1: there is none
  ScanLook look;
};

}  // namespace wellspring::world
