// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/shown_volume.h"

#include <algorithm>
#include <stdexcept>

#include "base/load_error.h"
#include "base/parallel.h"
#include "volume/format/open_volume.h"

namespace wellspring::volume {
namespace {

void add_normals_and_ranges(VolumeLevel& level) {
  Grid grid(level.size);
  std::ranges::copy(level.codes, grid.values.begin());
  level.normals = make_normals(grid);
  level.cells = cells_of(level.size);
  const size_t layer = size_t(level.cells.x) * size_t(level.cells.y);
  level.ranges.resize(layer * size_t(level.cells.z));
  parallel_each(level.cells.z, [&](int cz) {
    std::vector<const uint16_t*> slices;
    for (int z = cz * cell_side; z < std::min((cz + 1) * cell_side + 1, level.size.z); z++)
      slices.push_back(&level.codes[grid.index(0, 0, z)]);
    find_ranges(slices, level.size, &level.ranges[size_t(cz) * layer]);
  });
}

VolumeLevel halve_level(const VolumeLevel& from, glm::ivec3 size) {
  VolumeLevel to;
  to.size = size;
  to.codes.resize(size_t(size.x) * size_t(size.y) * size_t(size.z));
  const size_t slice = size_t(from.size.x) * size_t(from.size.y);
  parallel_each(size.z, [&](int z) {
    const uint16_t* front = &from.codes[size_t(2 * z) * slice];
    const uint16_t* behind = &from.codes[size_t(std::min(2 * z + 1, from.size.z - 1)) * slice];
    for (int y = 0; y < size.y; y++)
      halve_row(front, behind, from.size, y,
                &to.codes[(size_t(z) * size_t(size.y) + size_t(y)) * size_t(size.x)]);
  });
  return to;
}

double least_distance(const glm::dmat4& to_metres) {
  return std::min({glm::length(glm::dvec3(to_metres[0])), glm::length(glm::dvec3(to_metres[1])),
                   glm::length(glm::dvec3(to_metres[2]))});
}

ShownVolume show_bricks(BrickFile file, std::shared_ptr<BrickPool> pool) {
  ShownVolume shown;
  static_cast<CodeScale&>(shown) = file.scale;
  shown.to_metres = file.to_metres;
  shown.voxel = least_distance(file.to_metres);
  shown.code_counts = file.code_counts;
  for (size_t k = 0; k < file.levels.size(); k++) {
    VolumeLevel& level = shown.levels.emplace_back();
    level.size = file.levels[k].size, level.cells = cells_of(level.size);
    level.ranges = std::move(file.ranges[k]);
  }
  file.ranges.clear();
  shown.bricks =
      std::make_shared<ResidentBricks>(std::move(file), pool ? pool : shared_brick_pool());
  return shown;
}

}  // namespace

ShownVolume make_shown_volume(const Volume& volume) {
  if (volume.samples() >= size_t(1) << 31)
    throw std::length_error("a volume of 2^31 samples or more cannot be shown");
  ShownVolume shown;
  static_cast<CodeScale&>(shown) = code_scale_of(volume);
  shown.to_metres = volume.to_metres;
  shown.voxel = least_distance(volume.to_metres);
  VolumeLevel& finest = shown.levels.emplace_back();
  finest.size = volume.size;
  finest.codes.resize(volume.samples());
  parallel_each(volume.size.z, [&](int z) {
    size_t index = size_t(z) * size_t(volume.size.x) * size_t(volume.size.y);
    for (int y = 0; y < volume.size.y; y++, index += size_t(volume.size.x))
      code_row(volume, shown, y, z, &finest.codes[index]);
  });
  shown.code_counts.resize(code_bins);
  for (const uint16_t code : finest.codes) shown.code_counts[code * size_t(code_bins) / 65536]++;
  const std::vector<glm::ivec3> sizes = level_sizes(volume.size);
  for (size_t k = 1; k < sizes.size(); k++)
    shown.levels.push_back(halve_level(shown.levels.back(), sizes[k]));
  for (VolumeLevel& level : shown.levels) add_normals_and_ranges(level);
  return shown;
}

ShownVolume open_shown_volume(const std::string& path, std::shared_ptr<BrickPool> pool) {
  if (is_brick_file(path)) return show_bricks(open_bricks(path), std::move(pool));
  const Volume volume = open_volume(path);
  try {
    return make_shown_volume(volume);
  } catch (const std::length_error& error) {
    throw LoadError(path, "", std::string(error.what()) + " without bricks");
  }
}

}  // namespace wellspring::volume
