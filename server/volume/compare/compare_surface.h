// SPDX-License-Identifier: Apache-2.0
// Compares a surface with a scan, from registration to colours.
#pragma once
#include <vector>

#include "volume/compare/report.h"

namespace wellspring::volume {

struct CompareSettings {
  ConeSettings cone;
  bool registers = true;           // false: the frames are taken as they are
  std::vector<ControlPair> pairs;  // with which registration begins; none: with principal axes
  double kept_share = 0.8;         // RegistrationSettings
  double spacing_voxels = 2;       // between points on triangles
};

// Moves `mesh` to where it was registered. The scale of colours is of distances, and reaches from
// the first to the last percent. Names of files, profile, plots and glyphs are left to the caller.
Comparison compare_surface(const DensityField& field, const CompareSettings& settings,
                           SurfaceMesh& mesh);

}  // namespace wellspring::volume
