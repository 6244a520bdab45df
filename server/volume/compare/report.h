// SPDX-License-Identifier: Apache-2.0
// Tells the result of a comparison to people and to programs.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "volume/compare/deviation_colors.h"
#include "volume/compare/lens.h"
#include "volume/compare/registration.h"
#include "volume/compare/statistics.h"

namespace wellspring::volume {

// All that a comparison found.
struct Comparison {
  std::string mesh, volume;  // names of the files
  size_t triangles = 0, flat_triangles = 0, vertices = 0;
  glm::ivec3 grid{0};
  double voxel = 0;  // metres
  ConeSettings settings;
  double threshold = 0;                      // density per metre, the one that was used
  std::optional<Registration> registration;  // none: the frames were taken as they are
  // Points on the triangles, then one for each vertex, in the volume's metres.
  std::vector<SurfacePoint> points;
  std::vector<Deviation> deviations;
  DeviationSummary summary;
  ColorScale scale;
  std::optional<RayProfile> profile;
  std::vector<BoxPlot> plots;
  std::vector<DistanceGlyph> glyphs;
};

// Returns some lines for people.
std::string report_text(const Comparison& comparison);
// Returns a JSON object: units stand in the names (_mm, _deg, _voxels), shares are 0 to 1.
std::string report_json(const Comparison& comparison);
// Returns a table of the points with a line of names; distances are empty where nothing was found.
std::string report_csv(const Comparison& comparison);

}  // namespace wellspring::volume
