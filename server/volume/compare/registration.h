// SPDX-License-Identifier: Apache-2.0
// Lays a surface into a volume by a rigid move (Malik, Heinzl, Gröller, WSCG 2011, section 3:
// iterated closest points, Besl and McKay 1992), from control points or without.
#pragma once
#include <string>
#include <vector>

#include "volume/compare/density.h"
#include "volume/compare/surface_mesh.h"

namespace wellspring::volume {

// A place on the surface and the same place in the volume, both in metres.
struct ControlPair {
  dvec3 surface{0}, volume{0};
};

// Reads {"pairs": [{"surface_m": [x, y, z], "volume_m": [x, y, z]}, ...]}. Throws LoadError if
// there are fewer than three, or all lie on one line.
std::vector<ControlPair> read_control_pairs(const std::string& file);

struct RegistrationSettings {
  double kept_share = 0.8;  // the best points pull; the others do not
  int most_iterations = 60;
  double threshold = 0;  // density per metre, as ConeSettings has it
  double reach = 16;     // voxels, as ConeSettings has it
};

struct Registration {
  dmat4 to_volume{1};            // from the mesh's metres to the volume's
  double mean_square_error = 0;  // square metres, of the points that are kept
  int iterations = 0;            // coarse and fine ones, from the best start
  double found_share = 0;        // share of points with a boundary within reach
  std::string start;             // "control points", "as they are" or "principal axes"
};

// Starts from the control pairs, if there are any; else from the best of all 24 ways to lay the
// principal axes on one another, and of the frames as they are. First the nearest boundary points
// of the volume pull at the surface's, by point-to-point steps; then boundaries along the normals,
// to a fraction of a voxel, by point-to-plane steps of those points whose gap is nearest to
// the middle one. Throws std::invalid_argument if the mesh has
// no triangle with an area, or the volume no boundary.
Registration register_surface(const SurfaceMesh& mesh, const DensityField& field,
                              const std::vector<ControlPair>& pairs,
                              const RegistrationSettings& settings);

// Returns places in metres where densities cross the split between their classes, between
// neighbouring samples: evenly chosen ones, at most `most`.
std::vector<dvec3> boundary_points(const DensityField& field, size_t most);

}  // namespace wellspring::volume
