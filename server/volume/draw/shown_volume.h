// SPDX-License-Identifier: Apache-2.0
// A volume made ready for rays: its values as 16-bit codes with normals beside them, in levels of
// detail, whole in memory or in bricks that come when they are looked for; and the range of codes
// in each cell of 8 x 8 x 8, so that rays leap over what is empty.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "volume/bricks/brick_pool.h"
#include "volume/codes.h"
#include "volume/reconstruct/normal_grid.h"
#include "volume/reconstruct/sample_box.h"
#include "volume/volume.h"

namespace wellspring::volume {

// Sample (x, y, z) of level k lies at ((x, y, z) + 0.5) * 2^k - 0.5 of the finest level.
struct VolumeLevel {
  glm::ivec3 size{0};
  std::vector<uint16_t> codes;  // x fastest; none where there are only bricks
  NormalGrid normals;
  glm::ivec3 cells{0};
  std::vector<CodeRange> ranges;  // one for each cell, x fastest (find_ranges())
  // Hold color_row() of red, green and blue of a volume of colours. Empty: tables alone give
  // colour.
  std::vector<uint16_t> colors[3];

  // Only of whole levels.
  SampleBox<uint16_t> box() const { return whole_box(codes.data(), size); }
};

struct ShownVolume : CodeScale {
  std::vector<VolumeLevel> levels;         // the finest first; never empty
  glm::dmat4 to_metres{1};                 // as Volume's, of the finest level
  double voxel = 1;                        // the smallest distance of samples, metres
  std::vector<uint64_t> code_counts;       // the finest level has so many, by code_bins even bins
  std::shared_ptr<ResidentBricks> bricks;  // null: all levels are whole
  int whole_level = 0;                     // the finest of those that are whole

  // Returns how many bricks that pictures looked for have come so far. Any thread.
  uint64_t arrivals() const { return bricks ? bricks->arrivals() : 0; }
};

// Takes a volume of one channel; of three, their mean. Values that are not finite count as the
// least finite one. Takes about 7 bytes a sample.
// Throws std::length_error beyond 2^31 samples.
ShownVolume make_shown_volume(const Volume& volume);

// Returns a copy that begins with a level, whole_level or a coarser one.
ShownVolume coarser(const ShownVolume& volume, int level);
// Gives a whole volume colours: red, green and blue of the finest level's samples, as codes of the
// square roots of linear light. Coarser levels get means.
void set_colors(std::array<std::vector<uint16_t>, 3> planes, ShownVolume& volume);

// Opens a file of bricks (volume/bricks/brick_file.h) at once, to be shown out of this pool,
// null: shared_brick_pool(); any other file is read as open_volume() does, and is whole in memory.
// Throws LoadError that names file and place.
ShownVolume open_shown_volume(const std::string& path, std::shared_ptr<BrickPool> pool = nullptr);

}  // namespace wellspring::volume
