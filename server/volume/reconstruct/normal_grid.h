// SPDX-License-Identifier: Apache-2.0
// Normals of a grid's samples, which are made once, so that a picture in motion can be lit for the
// price of reading them (scenario 1 of Csébfalvi and Domonkos, Prefiltered Gradient Reconstruction
// for Volume Rendering, with central differences).
#pragma once
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "volume/volume.h"

namespace wellspring::volume {

// A packed normal has x, y and z as signed whole numbers of 10 bits, x lowest, of this step. It is
// 0 where there is no normal, and else at most 0.1 degrees off. A word is as easily read as the
// 8-bit numbers that would be 0.4 degrees off.
constexpr float normal_step = 1.0f / 511;

// Packs a direction of any length; 0 stays 0.
uint32_t pack_normal(glm::dvec3 direction);
// Returns the whole numbers: normals times 511.
inline Lanes3 unpack_normals(const LaneBits& words) {
  auto part = [&](int shift) {
    return __builtin_convertvector(lanes_as<LaneMask>(words << shift) >> 22, Lanes);
  };
  return {part(22), part(12), part(2)};
}

struct NormalGrid {
  glm::ivec3 size{0};
  std::vector<uint32_t> words;  // packed, x fastest
};

// Makes the normals of all samples: the way in which values fall fastest, out of what is dense.
// They are counted in samples, not metres: the inverse transpose of `Volume::to_metres` turns them.
// Differences are of both neighbours, at the border of the sample and its one neighbour.
NormalGrid make_normals(const Grid& grid);

}  // namespace wellspring::volume
