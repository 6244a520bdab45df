// SPDX-License-Identifier: Apache-2.0
// Gaussian splats in memory, activated, as they are drawn (Kerbl et al. 2023, "3D Gaussian
// Splatting for Real-Time Radiance Field Rendering", section 4).
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::scan {

// Numbers of spherical harmonics' coefficients beyond the constant one, by degree 0 to 3.
inline constexpr int splat_harmonics[] = {0, 3, 8, 15};

struct SplatSet {
  std::vector<vec3> place;     // metres or the file's unit; the axes are the file's
  std::vector<vec3> scale;     // standard deviation along the axes, not negative
  std::vector<quat> turn;      // unit
  std::vector<float> opacity;  // 0 to 1
  std::vector<vec3> color;     // sRGB-encoded, 0.5 + 0.2820948 f_dc; may leave 0 to 1
  int degree = 0;              // spherical harmonics' degree, 0 to 3
  // splat_harmonics[degree] colours a splat, one splat after the other, in the order and with the
  // signs of the reference's eval_sh: degree 1 is -y, z, -x.
  std::vector<vec3> harmonics;
  std::string format;                // its name, for people
  std::vector<std::string> notices;  // sentences about odd things that could be read all the same
  size_t size() const { return place.size(); }
};

}  // namespace wellspring::scan
