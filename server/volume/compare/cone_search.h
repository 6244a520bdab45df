// SPDX-License-Identifier: Apache-2.0
// Finds, from points on a surface, the nearest boundary of material in a volume, within double
// cones (Malik, Heinzl, Gröller, WSCG 2011, section 3.1). The paper leaves open the cone's height,
// the rays' density and steps, and the threshold: these are ours.
#pragma once
#include <vector>

#include "volume/compare/density.h"
#include "volume/compare/surface_mesh.h"

namespace wellspring::volume {

// Says which steps of density are boundaries: all, or those at which it falls along the surface's
// normal, as it does at the surface of what is denser than its surroundings.
enum class Boundary { any, falling };

inline constexpr double longest_reach = 64;  // voxels

struct ConeSettings {
  double reach = 16;     // voxels: length of the rays to either side, at most longest_reach
  double threshold = 0;  // density per metre that a boundary's slope exceeds; 0: automatic
  float ray_spacing = 9 * pi / 180;  // radians between neighbouring rays, about
  Boundary boundary = Boundary::any;
};

// Returns the threshold that is used along the shortest edge of a voxel: an automatic one is a
// tenth of what lies between the two classes of densities, per voxel. Infinite for a volume of one
// density.
double slope_threshold(const DensityField& field, const ConeSettings& settings);

// Tells how far the volume's boundary is from a surface point.
struct Deviation {
  bool found = false;       // all else is 0 where nothing was found, but the cone's base
  dvec3 boundary{0};        // metres: the boundary's nearest place
  vec3 boundary_normal{0};  // unit: to where the density falls
  vec3 ray{0};              // unit: the ray's direction, to the outside
  float distance = 0;       // metres: + inside the surface (material is missing), - outside
  float uncertainty = 0;    // metres: the farthest boundary within a voxel, less the distance
  float normal_angle = 0;   // radians from the surface's normal; 0 to pi / 2 where any is taken
  float cone_base = 0;      // metres: diameter of the double cone's base
};

// Returns a deviation for each point. Along each ray, densities at half voxels pass a median of
// five; boundaries are the peaks and valleys of their first derivative above the threshold, to a
// fraction of a step by a parabola; the nearest of all rays counts. Uncertainty: eight rays around
// the nearest, within a voxel at the boundary and within the search angle. Points that are not
// finite, and points without a normal, find nothing.
std::vector<Deviation> find_deviations(const DensityField& field,
                                       const std::vector<SurfacePoint>& points,
                                       const ConeSettings& settings);

}  // namespace wellspring::volume
