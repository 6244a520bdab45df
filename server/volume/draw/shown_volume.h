// SPDX-License-Identifier: Apache-2.0
// A volume made ready for rays: its values as 16-bit codes with normals beside them, in levels of
// detail, and the range of codes in each cell of 8 x 8 x 8, so that rays leap over what is empty.
#pragma once
#include <vector>

#include "volume/reconstruct/normal_grid.h"
#include "volume/reconstruct/sample_box.h"
#include "volume/volume.h"

namespace wellspring::volume {

inline constexpr int cell_side = 8;
inline constexpr float most_code = 65535;

struct CodeRange {
  uint16_t least = 65535, most = 0;
};

// Sample (x, y, z) of level k lies at ((x, y, z) + 0.5) * 2^k - 0.5 of the finest level.
struct VolumeLevel {
  glm::ivec3 size{0};
  std::vector<uint16_t> codes;  // x fastest
  NormalGrid normals;
  glm::ivec3 cells{0};
  // One for each cell, x fastest, of the samples that places in it lie between: one more on each
  // side that is not the border.
  std::vector<CodeRange> ranges;
  // Of a volume of colours: for each sample, square roots of red, green and blue over the largest
  // of them, as codes. Empty: tables alone give colour.
  std::vector<uint8_t> colors[3];

  SampleBox<uint16_t> box() const { return whole_box(codes.data(), size); }
};

struct ShownVolume {
  std::vector<VolumeLevel> levels;  // the finest first; never empty
  double low = 0, high = 1;         // measured by code 0 and by code 65535; low < high
  glm::dmat4 to_metres{1};          // as Volume's, of the finest level
  double voxel = 1;                 // the smallest distance of samples, metres

  float code_of(double value) const {
    return float((value - low) / (high - low) * double(most_code));
  }
};

// Takes a volume of one channel; of three, the largest, and colours. Integers of three channels are
// display codes, floats are linear. Values that are not finite count as the
// least finite one. Takes about 7 bytes a sample.
// Throws std::length_error beyond 2^31 samples.
ShownVolume make_shown_volume(const Volume& volume);

}  // namespace wellspring::volume
