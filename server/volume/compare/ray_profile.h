// SPDX-License-Identifier: Apache-2.0
// Shows what the ray of one surface point met (Malik, Heinzl, Gröller, WSCG 2011, section 3.2,
// figure 7).
#pragma once
#include <vector>

#include "volume/compare/cone_search.h"

namespace wellspring::volume {

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
