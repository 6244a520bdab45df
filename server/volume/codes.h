// SPDX-License-Identifier: Apache-2.0
// A volume is drawn from 16-bit codes of what its samples measure, in levels of detail, and from
// the range of codes in each cell of 8 x 8 x 8, so that rays leap over what is empty. Functions
// take rows and slices, so that volumes larger than memory go through them piece by piece.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "volume/volume.h"

namespace wellspring::volume {

inline constexpr int cell_side = 8;
inline constexpr float most_code = 65535;
inline constexpr int code_bins = 128;  // the histogram of codes has so many

struct CodeRange {
  uint16_t least = 65535, most = 0;
};

struct CodeScale {
  double low = 0, high = 1;  // measured by code 0 and by code 65535; low < high

  float code_of(double value) const {
    return float((value - low) / (high - low) * double(most_code));
  }
};

// Returns the least and the largest finite value of a volume's one channel; of three, of the
// largest of them as linear light: integers of colours are display codes, floats are linear.
CodeScale code_scale_of(const Volume& volume);
// Writes the codes of a row of samples. Values that are not finite become code 0.
void code_row(const Volume& volume, const CodeScale& scale, int y, int z, uint16_t* to);

// Writes codes of the square roots of a channel over the largest of its sample's, as linear light.
void color_row(const Volume& volume, int channel, int y, int z, uint16_t* to);

// Returns the sizes of all levels of detail, the finest first. Sample (x, y, z) of level k lies at
// ((x, y, z) + 0.5) * 2^k - 0.5 of the finest level.
std::vector<glm::ivec3> level_sizes(glm::ivec3 finest);
// Writes row `y` of the next coarser level, of two slices of a level: means of 2 x 2 x 2 samples.
// The last sample of an odd side counts twice, so `behind` may be `front`.
void halve_row(const uint16_t* front, const uint16_t* behind, glm::ivec2 size, int y, uint16_t* to);

inline glm::ivec3 cells_of(glm::ivec3 size) { return (size + cell_side - 1) / cell_side; }
// Writes the ranges of one layer of cells, x fastest, of its slices: nine, or up to the volume's
// end. A cell's range is of the samples that places in it lie between: one more on each side that
// is not the border.
void find_ranges(std::span<const uint16_t* const> slices, glm::ivec2 size, CodeRange* to);

}  // namespace wellspring::volume
