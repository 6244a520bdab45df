// SPDX-License-Identifier: Apache-2.0
// The densities of a volume as the rays of a comparison sample them: the one place that does.
#pragma once
#include <glm/glm.hpp>

#include "base/simd.h"
#include "volume/volume.h"

namespace wellspring::volume {

struct DensityField {
  Grid grid;
  dmat4 to_metres{1}, to_index{1};  // from index to metres, and back
  double voxel = 0;                 // metres: the shortest way to a neighbouring sample
  // The best split of the densities into two classes, and the mean of each (Otsu 1979). All are
  // equal where the volume has one density.
  double split = 0, low = 0, high = 0;
};

// Throws std::invalid_argument for a volume that is empty, has more than 2^31 - 1 samples, or whose
// place is not finite or singular.
DensityField make_density_field(const Volume& volume, int channel = 0);

// Returns the densities at eight places, in index: trilinear; beyond the grid it goes on as at its
// border. Places that are not finite give some density of the grid.
Lanes sample_density(const DensityField& field, const Lanes3& place);

// Returns the density's gradient per metre at a place in metres, from central differences over two
// samples, smoothed across.
dvec3 density_gradient(const DensityField& field, dvec3 place);

}  // namespace wellspring::volume
