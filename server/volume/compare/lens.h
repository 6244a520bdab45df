// SPDX-License-Identifier: Apache-2.0
// Shows deviations in a part of the surface: glyphs and box plots (Malik, Heinzl, Gröller, WSCG
// 2011, sections 3.1 and 3.2, figures 4 and 8).
#pragma once
#include <vector>

#include "volume/compare/cone_search.h"

namespace wellspring::volume {

// A ball of the surface that is looked at.
struct LensArea {
  dvec3 middle{0};    // metres
  double radius = 0;  // metres
};

enum class FoundSide { none, inside, outside };

// An arrow along the surface's normal, with a disc whose diameter is the cone's base.
struct DistanceGlyph {
  dvec3 position{0};
  vec3 normal{0};
  double arrow = 0;          // metres along the normal: minus the signed distance
  double disc_diameter = 0;  // metres
  FoundSide side = FoundSide::none;
  vec3 disc_color{1};  // linear RGB: inside yellow, outside blue, no difference white
};

// Distances up to `tolerance` metres are no difference.
DistanceGlyph distance_glyph(const SurfacePoint& point, const Deviation& deviation,
                             double tolerance);

// Sums up the points of one neighbourhood for a box plot; distances are in metres.
struct BoxPlot {
  dvec3 position{0};  // mean of the points
  vec3 normal{0};  // mean of the normals, unit: the axis of a plot in 3D; one in 2D faces the eye
  double diameter = 0;  // mean of the cones' bases, for 3D
  size_t count = 0, found = 0;
  double least = 0, lower_quartile = 0, median = 0, upper_quartile = 0, greatest = 0;
  double mean = 0, deviation = 0;  // standard deviation
  double uncertainty = 0;          // mean
};

// Returns the plot of these points; all but position, normal and count are 0 where nothing was
// found.
BoxPlot box_plot(const std::vector<SurfacePoint>& points, const std::vector<Deviation>& deviations,
                 const std::vector<size_t>& chosen);

// Returns a plot for each neighbourhood of the lens: the points in a cube of this size in metres.
std::vector<BoxPlot> lens_plots(const std::vector<SurfacePoint>& points,
                                const std::vector<Deviation>& deviations, const LensArea& lens,
                                double size);

// Returns the glyphs of the points in the lens that lie nearest to the middles of such cubes.
std::vector<DistanceGlyph> lens_glyphs(const std::vector<SurfacePoint>& points,
                                       const std::vector<Deviation>& deviations,
                                       const LensArea& lens, double size, double tolerance);

// Shows what the ray of one surface point met (section 3.2, figure 7).

struct RayProfile {
  // Places along the ray in metres: 0 is the surface, positive ones are outside; and the density's
  // first derivative there, per metre.
  std::vector<double> places, slopes;
  double threshold = 0;  // the slope of a boundary exceeds it
  bool found = false;
  double boundary = 0;  // place of the boundary in metres
  double distance = 0;  // signed, as Deviation has it
};

// Returns the profile along the ray that won, or along the normal where nothing was found.
RayProfile ray_profile(const DensityField& field, const SurfacePoint& point,
                       const Deviation& deviation, const ConeSettings& settings);

}  // namespace wellspring::volume
